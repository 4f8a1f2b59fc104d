"""The robots of the measurements: the same URDF text for every library."""

from dataclasses import dataclass
from importlib.metadata import distribution
from pathlib import Path
from xml.etree import ElementTree

from dynamics_node import RobotModel
import numpy as np

ROOT = Path(__file__).parents[1]
# Without influence on a fixed-base robot without contact; friction, in `dynamics`, differs between
# libraries.
_DROPPED = ('visual', 'collision', 'dynamics', 'safety_controller', 'calibration')


@dataclass(frozen=True)
class Robot:
    """
    One robot and its states.

    Attributes
    ----------
    name : str
    text : str
        URDF: links with inertia and joints with limits, nothing else.
    model : RobotModel
        This library's model of that text.
    states : list of (numpy.ndarray, numpy.ndarray, numpy.ndarray)
        q, q̇ and a third vector, which serves as q̈ or as τ; shape (n,) each, float64.

    """

    name: str
    text: str
    model: RobotModel
    states: list

    @property
    def n(self):
        """Number of joints."""
        return len(self.model.joint_names)

    def check_joint_order(self, names):
        """
        Check that a library has the same order of joints.

        Parameters
        ----------
        names : tuple of str
            Joints in the library's order.

        Raises
        ------
        ValueError
            If the order differs.

        """
        if names != self.model.joint_names:
            raise ValueError(f'joints: expected {self.model.joint_names}, got {names}')


def arms():
    """
    Return the arms of the single calls.

    Returns
    -------
    list of Robot
        UR5 (6 joints), Panda and arm7 (7 joints each). Their fingers are fixed, with their mass:
        some libraries have no mimic joints.

    """
    package = distribution('example-robot-data')
    public = Path(str(package.locate_file('cmeel.prefix/share/example-robot-data/robots')))
    return [
        make_robot('UR5', (public / 'ur_description/urdf/ur5_robot.urdf').read_text()),
        make_robot(
            'Panda',
            (public / 'panda_description/urdf/panda.urdf').read_text(),
            fixed=('panda_finger_joint1', 'panda_finger_joint2'),
        ),
        arm7(),
    ]


def arm7():
    """
    Return the 7-joint arm of this repository, its fingers fixed.

    Returns
    -------
    Robot

    """
    return make_robot(
        'arm7',
        (ROOT / 'config/robots/arm7.urdf').read_text(),
        fixed=('left_finger_slide', 'right_finger_slide'),
    )


def make_robot(name, text, fixed=(), count=32):
    """
    Reduce a URDF to its dynamics and draw states for it.

    Parameters
    ----------
    name : str
    text : str
        URDF.
    fixed : sequence of str
        Joints to fix.
    count : int
        Number of states, the same in every run.

    Returns
    -------
    Robot

    """
    text = reduced(text, fixed)
    model = RobotModel.from_urdf(text)
    n = len(model.joint_names)
    rng = np.random.default_rng(7)
    states = [
        (rng.uniform(-1.0, 1.0, n), rng.normal(0.0, 1.0, n), rng.normal(0.0, 1.0, n))
        for _ in range(count)
    ]
    return Robot(name, text, model, states)


def reduced(text, fixed=()):
    """
    Return a URDF with links, inertials, joints and limits only.

    Parameters
    ----------
    text : str
        URDF.
    fixed : sequence of str
        Joints to fix.

    Returns
    -------
    str

    """
    root = ElementTree.fromstring(text)
    for element in list(root):
        if element.tag not in ('link', 'joint'):
            root.remove(element)
            continue
        is_fixed = element.tag == 'joint' and element.get('name') in fixed
        if is_fixed:
            element.set('type', 'fixed')
        dropped = _DROPPED + (('axis', 'limit', 'mimic') if is_fixed else ())
        for child in list(element):
            if child.tag in dropped:
                element.remove(child)
    return ElementTree.tostring(root, encoding='unicode')
