"""A model that is looked at once: nobody compiles machine code for it."""

from .arguments import gravity_vector
from .robot_model import RobotModel, STANDARD_GRAVITY
from .specialisation import Specialisation
from ..kernels.packing import pack


def one_off_model(tree, gravity=STANDARD_GRAVITY):
    """
    Return the model of a tree that starts no compiler, however often it is asked.

    Machine code that lies on the disk already is used. What `with_payload` and the like make of
    it starts none either.

    Parameters
    ----------
    tree : KinematicTree
    gravity : array_like, shape (3,)
        m/s², in the base frame.

    Returns
    -------
    RobotModel

    Raises
    ------
    ArgumentError
        If gravity is not three finite numbers.

    """
    gravity = gravity_vector(gravity)
    return RobotModel(tree, gravity, specialisation=_WithoutCompiler(*pack(tree, gravity)))


class _WithoutCompiler(Specialisation):
    """Takes what is there, makes nothing."""

    def begin(self, loads=False):
        """Do not."""
