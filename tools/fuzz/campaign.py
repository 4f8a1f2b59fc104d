"""`Campaign`: thousands of inputs for one target; answers, time, memory and findings."""

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

# Largest processor time of one input, s.
MAX_TIME = 1.0
# Time by the clock after which an input is given up, s.
_HANGS = 20.0
# Largest growth of memory between the first tenth of the inputs and the end, MB.
MAX_GROWTH = 32.0
# Inputs per run of hypothesis, which keeps all of them in memory.
_BATCH = 500
# Findings that end a campaign, repeated ones included.
_MAX_FAILURES = 10
_PAGE = os.sysconf('SC_PAGE_SIZE')


class SlowError(Exception):
    """An input took too long."""


@dataclass
class Finding:
    """An error, and the input that reproduces it."""

    error: str
    where: str
    content: bytes
    path: Path | None = None


@dataclass
class Result:
    """
    The figures of one target.

    Times in s: `slowest` of the processor, `longest` by the clock. Resident memory in MB: after
    the first tenth of the inputs, at the end, and its peak.

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
    """Runs inputs through one target."""

    def __init__(self, target, folder):
        """
        Warm up: lazy imports are no growth of memory.

        Parameters
        ----------
        target : module
            `description_target` or `joint_state_target`.
        folder : pathlib.Path
            Folder for the findings.

        """
        self.target = target
        self.result = Result(target.NAME)
        self._folder = folder
        folder.mkdir(parents=True, exist_ok=True)
        # An input that crashes the process stays here.
        self._running = folder / f'running{target.SUFFIX}'
        self._file = os.open(self._running, os.O_WRONLY | os.O_CREAT)
        self._failing = None
        target.warm_up()

    def run(self, inputs, seed, say=lambda text: None):
        """
        Run inputs through the target.

        Parameters
        ----------
        inputs : int
        seed : int
            Seed of the inputs.
        say : callable(str)
            Prints a line about the progress.

        Returns
        -------
        Result

        """
        result, start = self.result, time.monotonic()
        while result.inputs < inputs and result.failures < _MAX_FAILURES:
            tenth = result.inputs * 10 // inputs
            self._run_batch(
                min(_BATCH, inputs - result.inputs, max(1, inputs // 10)), seed + result.inputs
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
            self._add_finding(
                'memory',
                f'MemoryError: from {result.early_memory:.0f} to {result.late_memory:.0f} MB',
                b'',
            )
        result.duration = time.monotonic() - start
        os.close(self._file)
        self._running.unlink()
        return result

    def take(self, data):
        """Run one input through the target; findings are raised."""
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
            self._add_finding('hangs', f'SlowError: no answer within {_HANGS:g} s', content)
        used, duration = time.process_time() - used, time.monotonic() - start
        result.inputs += 1
        result.longest = max(result.longest, duration)
        if used > result.slowest:
            result.slowest, result.slowest_size = used, len(content)
        if used > MAX_TIME:
            self._add_finding('slow', f'SlowError: {used:.1f} s', content)

    def _run_batch(self, count, seed):
        # Hypothesis shrinks a finding; the last failing input is the smallest.
        before = self.result.inputs

        def examine(drawn):
            for data in drawn:
                # Enough, unless hypothesis is shrinking an input.
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
            failure, data = self._failing
            # Hypothesis raises another error for an input that fails only sometimes.
            self._add_finding(
                _place(failure),
                f'{type(failure).__name__}: {failure}'
                + ('' if error is failure else f' ({type(error).__name__})'),
                self.target.to_bytes(data),
            )
        # Also if hypothesis could draw no new input.
        self.result.inputs = max(self.result.inputs, before + 1)

    def _add_finding(self, where, error, content):
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
    # Freed memory that the C library keeps is no growth.
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path('/proc/self/statm').read_text().split()[1]) * _PAGE / 1e6


def _peak_memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * 1024 / 1e6


def _place(error):
    """Return innermost file and line of an exception, and its type."""
    frame = traceback.extract_tb(error.__traceback__)[-1]
    return f'{Path(frame.filename).name}:{frame.lineno} {type(error).__name__}'


@contextmanager
def _alarm():
    """Raise SlowError if the code inside hangs."""

    def ring(*_):
        raise SlowError

    before = signal.signal(signal.SIGALRM, ring)
    # pytest-timeout may use the same timer.
    remaining, interval = signal.setitimer(signal.ITIMER_REAL, _HANGS)
    try:
        yield
    finally:
        signal.setitimer(signal.ITIMER_REAL, remaining, interval)
        signal.signal(signal.SIGALRM, before)
