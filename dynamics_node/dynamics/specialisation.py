"""The machine code of one robot, shared by all its models: fetched, made, handed out."""

import threading
import weakref

from ..kernels import specialised

# So many states are computed by the general kernel before it looks worth while to compile.
_WORTH_WHILE = 200


class Specialisation:
    """
    Machine code for one robot, or the way to it.

    It does not depend on gravity, so models of the robot under several gravities share it.

    Attributes
    ----------
    code : RobotCode or None
        None while there is none.

    """

    def __init__(self, structure, numbers):
        """
        Take the code from disk if it was made before.

        Parameters
        ----------
        structure, numbers : numpy.ndarray
            See `kernels.packing.pack`.

        """
        self.code = None
        self._packed = structure, numbers
        self._models: weakref.WeakSet = weakref.WeakSet()
        self._lock = threading.Lock()
        self._states = 0
        self._thread = None
        self._wanted = (len(structure) > 0 and specialised.is_wanted()
                        and specialised.is_supported())
        if self._wanted:
            self.code = specialised.from_disk(structure, numbers)

    def attach(self, model):
        """
        Give a model the code, now or when it is ready.

        Parameters
        ----------
        model : RobotModel
            Its `_use` is called with the code.

        """
        with self._lock:
            self._models.add(model)
        if self.code is not None:
            model._use(self.code)

    def count(self, states):
        """Notice that the general kernel has computed so many states; begin if it is often."""
        self._states += states
        if self._states >= _WORTH_WHILE and self._wanted and self._thread is None:
            self.begin()

    def begin(self):
        """Make the code in the background, unless it is there, being made or not wanted."""
        with self._lock:
            if self._wanted and self.code is None and self._thread is None:
                self._thread = specialised.make_in_background(*self._packed, self._ready)

    def wait(self):
        """Make the code and wait for it; return whether there is one."""
        self.begin()
        if self._thread is not None:
            self._thread.join()
        return self.code is not None

    def _ready(self, code):
        # In the background thread.
        with self._lock:
            self.code = code
            models = list(self._models)
        if code is not None:
            for model in models:
                model._use(code)
