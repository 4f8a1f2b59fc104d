"""The machine code of one robot, shared by all its models: fetched, made, handed out."""

import logging
import threading
import weakref

from .. import codegen

# So many calls to the general kernel make it look worth while to compile; a batch counts as one
# call per so many states.
_WORTH_WHILE = 200
_STATES_PER_CALL = 100
# Whether the background is ready is asked at every so many calls.
_ASK_EVERY = 50

_log = logging.getLogger(__name__)


class Specialization:
    """
    Machine code for one robot, or the way to it.

    It does not depend on gravity, so models of the robot under several gravities share it. A
    robot has two: the faster one knows the inertia of its bodies; the one `for_any_inertia` is
    shared by all models with a payload or rotors, so a new payload needs no compiler. It is a
    matter of speed only: whatever fails here is logged, and the general kernel goes on.

    Attributes
    ----------
    code : RobotCode or None
        None while there is none.
    for_any_inertia : Specialization or None
        The robot's code that takes the inertia of bodies and rotors as it comes; None if this
        is it.

    """

    def __init__(self, structure, numbers, any_inertia=False):
        """
        Take the code from disk if it was made before.

        Parameters
        ----------
        structure, numbers : numpy.ndarray
            See `kernels.packing.pack`.
        any_inertia : bool
            See `kernels.specialized.quantities`.

        """
        self.code = None
        self._packed = structure, numbers, any_inertia
        self._models: weakref.WeakSet = weakref.WeakSet()
        # A new model must not wait while another thread loads.
        self._lock, self._loading = threading.Lock(), threading.Lock()
        self._calls = 0
        self._loads = False
        self._process = None
        self._loader: threading.Thread | None = None
        self._wanted = len(structure) > 0 and codegen.is_wanted() and codegen.is_supported()
        # Fetched at once too, if it is on disk: a first payload may come in a control loop.
        self.for_any_inertia = (
            None if any_inertia else type(self)(structure, numbers, any_inertia=True)
        )
        if self._wanted:
            self._take()

    def __reduce__(self):
        return type(self), self._packed, {'for_any_inertia': self.for_any_inertia}

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
            self._hand_out([model])
        elif self._process is not None:
            # Begun before this model came: it may be ready.
            self.begin()

    def count(self, states):
        """Notice that the general kernel was asked for so many states; begin if it is often."""
        self._calls += max(1, states // _STATES_PER_CALL)
        if not self._wanted or self._calls < _WORTH_WHILE:
            return
        self._calls -= _ASK_EVERY
        self.begin()

    def begin(self, loads=False):
        """
        Have the code made in the background, or fetch it if that is done.

        Parameters
        ----------
        loads : bool
            Then that for any inertia too. One after the other: each takes a core for seconds.

        """
        self._loads = self._loads or loads
        if self.code is not None and loads and self.for_any_inertia is not None:
            self.for_any_inertia.begin()
        if not self._wanted or self.code is not None:
            return
        try:
            if self._process is None:
                self._process = codegen.start(*self._packed)
            elif self._process.poll() is not None:
                self._wanted = self._process.returncode == 0
                if self._wanted and self._loader is None:
                    # Loading takes some milliseconds: not in somebody's control loop.
                    self._loader = threading.Thread(target=self._take, name='dynamics_node load')
                    self._loader.start()
        except (OSError, RuntimeError) as error:  # no process or thread can be started
            self._give_up(error)

    def wait(self, loads=False):
        """
        Make the code here, or wait for the background; return whether there is one.

        Parameters
        ----------
        loads : bool
            That for any inertia too.

        Returns
        -------
        bool

        """
        if loads and self.for_any_inertia is not None:
            self.for_any_inertia.wait()
        if self._wanted and self.code is None:
            if self._process is not None:
                self._process.wait()
            self._take(make=True)
        return self.code is not None

    def _take(self, make=False):
        # Once: a thread that loads and a caller that waits may both come here.
        with self._loading:
            if self.code is not None:
                return
            code = None
            try:
                code = (codegen.make if make else codegen.from_disk)(*self._packed)
            except Exception as error:
                self._give_up(error)
            # Asked for, and not there: too large a robot, or a place that cannot be written.
            self._wanted = code is not None or (self._wanted and self._process is None)
            with self._lock:
                self.code = code
                models = list(self._models)
        if code is not None:
            self._hand_out(models)
            if self._loads and self.for_any_inertia is not None:
                self.for_any_inertia.begin()

    def _hand_out(self, models):
        for model in models:
            try:
                model._use(self.code)
            except Exception as error:
                self._give_up(error)

    def _give_up(self, error):
        self._wanted = False
        _log.warning(
            'no machine code for this robot, the general kernel goes on: %s: %s',
            type(error).__name__,
            error,
        )
