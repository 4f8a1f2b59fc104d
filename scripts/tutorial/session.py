"""Runs the page from its first block to its last, and records the output in it."""

import contextlib
import io
import os
from pathlib import Path
import re

from .page import Block
from .program import Program

ROOT = Path(__file__).resolve().parents[2]
_STAMP = re.compile(r'\[\d{9,}\.\d+\]')
_NUMBER = re.compile(r'-?\d+\.\d+(?:e[-+]?\d+)?')
# A stated line with this end fits every line that contains the text before it.
REST = ' ...'


class Session:
    """The running programs, and the names of the Python session."""

    def __init__(self):
        self._programs = {}
        self._names = {'__name__': 'tutorial'}
        self._printed = ''

    def run(self, parts):
        """
        Run a page.

        Parameters
        ----------
        parts : list of str or Block
            As `page.split` returns them.

        Returns
        -------
        list of str or Block
            The same parts with the present output.

        """
        before = Path.cwd()
        os.chdir(ROOT)
        try:
            return [
                part if isinstance(part, str) else Block(part.kind, part.order, self._run(part))
                for part in parts
            ]
        finally:
            os.chdir(before)

    def close(self):
        """End all programs."""
        with contextlib.ExitStack() as stack:
            for program in self._programs.values():
                stack.callback(program.stop)
        self._programs = {}

    def _run(self, block):
        if block.order.startswith('stop '):
            code = self._programs.pop(block.order.split()[1]).stop()
            assert code == 0, f'{block.order}: exit code {code}'
        if block.kind == 'python':
            assert not self._printed, f'the page does not show what was printed: {self._printed}'
            self._printed = self._python(block.text)
            return block.text
        if block.kind == 'console':
            return self._start(block)
        if block.order and not block.order.startswith('stop '):
            return self._lines(self._programs[block.order], block.text.splitlines())
        printed, self._printed = self._printed, ''
        return printed

    def _python(self, code):
        output = io.StringIO()
        with contextlib.redirect_stdout(output):
            exec(compile(code, 'docs/tutorial.md', 'exec'), self._names)
        return output.getvalue()

    def _start(self, block):
        first, *lines = block.text.splitlines()
        command = first.removeprefix('$ ')
        program = Program(command, ROOT)
        self._programs[block.order] = program
        return f'{first}\n' + self._lines(program, lines)

    def _lines(self, program, stated):
        return ''.join(
            program.next_line(lambda line, text=text: fits(text, line)) + '\n' for text in stated
        )


def fits(stated, line):
    """Return whether a line is the stated one, but for its stamp and the size of its numbers."""
    if stated.endswith(REST):
        return stated.removesuffix(REST) in line
    return shape(stated) == shape(line)


def shape(text):
    """Return a text without stamps and without the value of its decimal numbers."""
    return _NUMBER.sub('#', _STAMP.sub('[stamp]', text))


def numbers(text):
    """Return the decimal numbers of a text, without stamps."""
    return [float(number) for number in _NUMBER.findall(_STAMP.sub('', text))]
