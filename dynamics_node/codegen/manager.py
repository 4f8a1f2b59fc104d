"""The machine code of one robot, shared by all its models: when to fetch, compile and install."""

from collections.abc import Callable
import logging
import subprocess
import threading
from typing import Any
import weakref

from . import compile, python_entry, worker
from .compile import RobotCode
from ..kernels.packing import PackedModel

# Calls of the general kernel after which compiling pays.
_CALLS_BEFORE_COMPILING = 200
# States of a batch that count as one call.
_STATES_PER_CALL = 100
# Calls between two checks whether the compiler is ready.
_CALLS_PER_CHECK = 50

_log = logging.getLogger(__name__)


class Specialization:
    """
    Machine code for one robot, present or to come.

    It does not depend on gravity, so models of the robot under several gravities share it. A
    robot has two: the faster one contains the inertia of its bodies; the payload variant reads it
    when it runs, and so serves all models with a payload or rotors without another compilation.
    It affects speed only: failures are logged, and the general kernel remains in use.

    Attributes
    ----------
    code : RobotCode or None
        None while there is none.
    payload_variant : Specialization or None
        The robot's code for every payload and rotor inertia; None if this is it.

    """

    def __init__(self, packed: PackedModel, compile: bool = True):
        """
        Take the code from disk if it was compiled before.

        Parameters
        ----------
        packed : PackedModel
        compile : bool
            False: neither load machine code from disk nor compile any.

        """
        self.code: RobotCode | None = None
        self._arguments = packed, compile
        self._packed = packed
        self._owners: weakref.WeakKeyDictionary[Any, Callable[[Any, RobotCode], None]] = (
            weakref.WeakKeyDictionary()
        )
        # Two locks: a new model must not wait while another thread loads.
        self._lock, self._loading = threading.Lock(), threading.Lock()
        self._calls = 0
        self._with_payload_code = False
        self._process: subprocess.Popen[bytes] | None = None
        self._loader: threading.Thread | None = None
        self._wanted = compile and packed.body_count > 0 and _is_available()
        # Fetched at once too, if it is on disk: the first payload may come in a control loop.
        self.payload_variant: Specialization | None = (
            None if packed.payload_variant else type(self)(packed.with_payload_code(), compile)
        )
        if self._wanted:
            self._take()

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), self._arguments, {'payload_variant': self.payload_variant}

    def attach(self, owner: Any, install: Callable[[Any, RobotCode], None]) -> None:
        """
        Call a function with the code, now or when it is ready.

        Parameters
        ----------
        owner : object
            Referred to weakly; the function is forgotten with it.
        install : callable (owner, RobotCode) -> None
            Must not refer to the owner.

        """
        with self._lock:
            self._owners[owner] = install
        if self.code is not None:
            self._install([(owner, install)])
        elif self._process is not None:
            # Its compiler was started before this owner came, and may have ended.
            self.begin()

    def count(self, states: int) -> None:
        """Count a call of the general kernel; begin to compile if such calls are frequent."""
        self._calls += max(1, states // _STATES_PER_CALL)
        if not self._wanted or self._calls < _CALLS_BEFORE_COMPILING:
            return
        self._calls -= _CALLS_PER_CHECK
        self.begin()

    def begin(self, with_payload_code: bool = False) -> None:
        """
        Start a compiler in the background, or fetch its result if it has ended.

        Parameters
        ----------
        with_payload_code : bool
            Then compile the payload variant too. One after the other: each takes a core for
            seconds.

        """
        self._with_payload_code = self._with_payload_code or with_payload_code
        if self.code is not None and with_payload_code and self.payload_variant is not None:
            self.payload_variant.begin()
        if not self._wanted or self.code is not None:
            return
        try:
            if self._process is None:
                self._process = worker.start(self._packed)
            elif self._process.poll() is not None:
                self._wanted = self._process.returncode == 0
                if self._wanted and self._loader is None:
                    # Loading takes some milliseconds, too long for a control loop.
                    self._loader = threading.Thread(target=self._take, name='dynamics_node load')
                    self._loader.start()
        except (OSError, RuntimeError) as error:  # no process or thread can be started
            self._give_up(error)

    def wait(self, with_payload_code: bool = False) -> bool:
        """
        Compile the code in this process, or wait for the background compiler.

        Parameters
        ----------
        with_payload_code : bool
            The payload variant too.

        Returns
        -------
        bool
            Whether there is code; that of the payload variant does not count.

        """
        if with_payload_code and self.payload_variant is not None:
            self.payload_variant.wait()
        if self._wanted and self.code is None:
            if self._process is not None:
                self._process.wait()
            self._take(make=True)
        return self.code is not None

    def _take(self, make: bool = False) -> None:
        # A thread that loads and a caller that waits may both come here: the first one loads.
        with self._loading:
            if self.code is not None:
                return
            code = None
            try:
                code = compile.make(self._packed) if make else compile.from_disk(self._packed)
            except Exception as error:
                self._give_up(error)
            # After the compiler has ended without code: the robot is too large, or the folder
            # cannot be written.
            self._wanted = code is not None or (self._wanted and self._process is None)
            with self._lock:
                self.code = code
                owners = list(self._owners.items())
        if code is not None:
            self._install(owners)
            if self._with_payload_code and self.payload_variant is not None:
                self.payload_variant.begin()

    def _install(self, owners: list[tuple[Any, Callable[[Any, RobotCode], None]]]) -> None:
        assert self.code is not None
        for owner, install in owners:
            try:
                install(owner, self.code)
            except Exception as error:
                self._give_up(error)

    def _give_up(self, error: Exception) -> None:
        self._wanted = False
        _log.warning(
            'no machine code for this robot, the general kernel goes on: %s: %s',
            type(error).__name__,
            error,
        )


def _is_available() -> bool:
    return compile.is_wanted() and python_entry.is_supported()
