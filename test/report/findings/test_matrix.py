"""Mass matrices that cannot be inverted, or hardly."""

from dynamics_node import RobotModel, SingularMassMatrixError
from dynamics_node.report import make_report
import numpy as np
import pytest
from support.arms import arm, changed, rod


def test_a_point_mass_on_the_axis_of_its_joint_has_no_inertia():
    # Joint 5 turns about x, and all mass behind it lies on x.
    text = arm(tool=False)
    text = text.replace(
        rod(0.8, 0.15),
        '<inertial><origin xyz="0.1 0 0"/><mass value="0.8"/>'
        '<inertia ixx="0" ixy="0" ixz="0" iyy="0" iyz="0" izz="0"/></inertial>',
    )
    report = make_report(text, samples=200)
    [found] = [finding for finding in report.findings if finding.kind == 'singular_mass_matrix']
    assert (found.severity, found.subjects) == ('problem', ('joint5',))
    with pytest.raises(SingularMassMatrixError):
        RobotModel.from_urdf(text).forward_dynamics(np.zeros(5), np.zeros(5), np.zeros(5))


def test_a_matrix_that_loses_digits_is_a_note():
    text = changed(
        arm(tool=False), 'link5', mass=1e-5, tensor={'ixx': 1e-10, 'iyy': 1e-10, 'izz': 1e-10}
    )
    [found] = [
        finding
        for finding in make_report(text, samples=200).findings
        if finding.kind == 'ill_conditioned'
    ]
    assert (found.severity, found.subjects) == ('note', ('joint5',))
