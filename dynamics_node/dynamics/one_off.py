"""A model that is looked at once: nobody compiles machine code for it."""

from .arguments import gravity_vector
from .robot_model import RobotModel, STANDARD_GRAVITY
from ..codegen.manager import Specialization
from ..kernels.packing import pack


def one_off_model(tree, gravity=STANDARD_GRAVITY):
    """
    Return the model of a tree that starts no compiler, however often it is asked.

    Nor does it load machine code that lies on the disk: to compare it with the general kernel
    takes longer than to look at a robot once, and the same robot gives the same digits
    everywhere. What `with_payload` and the like make of it is the same.

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
    return RobotModel(tree, gravity, specialization=_WithoutCompiler(*pack(tree, gravity)))


class _WithoutCompiler(Specialization):
    """Neither takes machine code from disk nor has any made."""

    def begin(self, loads=False):
        """Do not."""

    def _take(self, make=False):
        pass
