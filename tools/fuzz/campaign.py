"""Thousands of inputs through one target: what came of them, how long they took, what memory."""

from collections import Counter
from contextlib import contextmanager
import ctypes
from dataclasses import dataclass, field
import gc
import os
from pathlib import Path
import resource
import signal
import time
import traceback
import warnings

from hypothesis import given, HealthCheck, Phase, settings
from hypothesis import seed as seeded

from .seeds import SIBLINGS

# Seconds of processor time that one input may take; by the clock it takes longer where other
# processes want the processor. Seconds by the clock after which it is given up.
MAX_TIME = 1.0
_HANGS = 20.0
# MB that the process may have grown between the first tenth of the inputs and the end.
MAX_GROWTH = 32.0
# Hypothesis remembers what it has tried: a fresh start every so many inputs keeps that small.
_AT_ONCE = 500
# Also of the same finding, found again in other inputs.
_ENOUGH_FINDINGS = 10
_PAGE = os.sysconf('SC_PAGE_SIZE')


class SlowError(Exception):
    """An input took longer than any may."""


@dataclass
class Finding:
    """What went wrong, and the input that does it again."""

    error: str
    where: str
    content: bytes
    path: Path | None = None


@dataclass
class Result:
    """
    The figures of one target.

    Times are seconds: of the processor, and by the clock. Memory is resident, in MB: after the
    first tenth of the inputs, at the end, and at most.

    """

    name: str
    answers: Counter = field(default_factory=Counter)
    inputs: int = 0
    slowest: float = 0.0
    slowest_size: int = 0
    longest: float = 0.0
    early_memory: float = 0.0
    late_memory: float = 0.0
    peak_memory: float = 0.0
    duration: float = 0.0
    failures: int = 0
    findings: dict = field(default_factory=dict)


class Campaign:
    """One target and the inputs that went through it."""

    def __init__(self, target, folder):
        """
        Warm up, so that what is loaded once is not taken for a growth of memory.

        Parameters
        ----------
        target : module
            `description_target` or `joint_state_target`.
        folder : pathlib.Path
            Where findings are written.

        """
        self.target = target
        self.result = Result(target.NAME)
        self._folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        # Whatever ends the process leaves its input here.
        self._running = folder / f'running{target.SUFFIX}'
        self._file = os.open(self._running, os.O_WRONLY | os.O_CREAT)
        self._failing = None
        target.warm_up()

    def run(self, inputs, seed, say=lambda text: None):
        """
        Put inputs through the target.

        Parameters
        ----------
        inputs : int
        seed : int
            The same seed draws the same inputs.
        say : callable(str)
            Takes a line about the progress.

        Returns
        -------
        Result

        """
        result, start = self.result, time.monotonic()
        while result.inputs < inputs and result.failures < _ENOUGH_FINDINGS:
            tenth = result.inputs * 10 // inputs
            self._some(
                min(_AT_ONCE, inputs - result.inputs, max(1, inputs // 10)), seed + result.inputs
            )
            if not result.early_memory and result.inputs * 10 >= inputs:
                result.early_memory = memory()
            if result.inputs * 10 // inputs > tenth:
                say(
                    f'{result.name}: {result.inputs} of {inputs} inputs, '
                    f'{time.monotonic() - start:.0f} s, {len(result.findings)} findings'
                )
        result.late_memory = memory()
        result.peak_memory = _peak_memory()
        if result.early_memory and result.late_memory > result.early_memory + MAX_GROWTH:
            self._found(
                'memory',
                f'MemoryError: from {result.early_memory:.0f} to {result.late_memory:.0f} MB',
                b'',
            )
        result.duration = time.monotonic() - start
        os.close(self._file)
        self._running.unlink()
        return result

    def take(self, data):
        """Put one input through the target; what is found is raised."""
        content = self.target.to_bytes(data)
        os.ftruncate(self._file, 0)
        os.pwrite(self._file, content, 0)
        result = self.result
        used, start = time.process_time(), time.monotonic()
        try:
            with _alarm(), warnings.catch_warnings():
                warnings.simplefilter('error')
                result.answers.update(self.target.check(data))
        except SlowError:
            result.answers['given up'] += 1
            self._found('hangs', f'SlowError: no answer within {_HANGS:g} s', content)
        used, duration = time.process_time() - used, time.monotonic() - start
        result.inputs += 1
        result.longest = max(result.longest, duration)
        if used > result.slowest:
            result.slowest, result.slowest_size = used, len(content)
        if used > MAX_TIME:
            self._found('slow', f'SlowError: {used:.1f} s', content)

    def _some(self, count, seed):
        # What hypothesis finds it makes smaller; the last input that fails is the smallest.
        before = self.result.inputs

        def examine(drawn):
            for data in drawn:
                # Enough, unless hypothesis is making an input smaller.
                if self._failing is None and self.result.inputs >= before + count:
                    return
                try:
                    self.take(data)
                except Exception as error:
                    self._failing = error, data
                    raise

        self._failing = None
        test = settings(
            max_examples=max(1, count // SIBLINGS),
            database=None,
            deadline=None,
            derandomize=False,
            suppress_health_check=list(HealthCheck),
            phases=(Phase.generate, Phase.shrink),
            report_multiple_bugs=False,
        )(seeded(seed)(given(self.target.inputs())(examine)))
        try:
            test()
        except Exception as error:
            if self._failing is None:
                raise
            wrong, data = self._failing
            # An input that fails now and then is a finding too, and hypothesis says so.
            self._found(
                _place(wrong),
                f'{type(wrong).__name__}: {wrong}'
                + ('' if error is wrong else f' ({type(error).__name__})'),
                self.target.to_bytes(data),
            )
        # Even if nothing new could be drawn.
        self.result.inputs = max(self.result.inputs, before + 1)

    def _found(self, where, error, content):
        findings = self.result.findings
        self.result.failures += 1
        if where in findings:
            return
        path = (
            self._folder
            / f'{self.target.NAME.replace(" ", "_")}_{len(findings)}{self.target.SUFFIX}'
        )
        path.write_bytes(content)
        findings[where] = Finding(error, where, content, path)


def memory():
    """Return the resident memory of this process, MB."""
    gc.collect()
    # What was freed, but is kept by the C library, is no growth.
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path('/proc/self/statm').read_text().split()[1]) * _PAGE / 1e6


def _peak_memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def _place(error):
    """Return where an exception comes from: the innermost file and line, and its type."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f'{Path(frame.filename).name}:{frame.lineno} {type(error).__name__}'


@contextmanager
def _alarm():
    """Raise SlowError where the code inside hangs."""

    def ring(*_):
        raise SlowError

    before = signal.signal(signal.SIGALRM, ring)
    # Somebody else may use the timer to end a test.
    remaining, interval = signal.setitimer(signal.ITIMER_REAL, _HANGS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, remaining, interval)
        signal.signal(signal.SIGALRM, before)
