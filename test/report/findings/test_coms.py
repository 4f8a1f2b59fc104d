"""Centers of mass outside the robot."""

from dynamics_node.report import make_report
from support.arms import arm, changed


def findings(text):
    """Return the findings of the kind."""
    return [
        finding for finding in make_report(text, samples=300).findings if finding.kind == 'far_com'
    ]


def test_millimeters_written_as_meters_are_found():
    [found] = findings(changed(arm(), 'link3', com=[125.0, 0.0, 0.0]))
    assert (found.severity, found.subjects) == ('warning', ('link3',))
    assert '125 m' in found.what and 'a thousandth of that, 0.125 m' in found.effect
    right = make_report(arm(), samples=300)
    joint = next(joint for joint in right.joints if f"'{joint.name}'" in found.effect)
    assert f'would be {joint.gravity.magnitude:.3g} N m' in found.effect


def test_coordinates_of_the_whole_robot_are_found():
    [found] = findings(changed(arm(), 'link5', com=[1.1, 0.0, 0.0]))
    assert found.subjects == ('link5',)


def test_a_center_of_mass_a_little_outside_is_no_finding():
    assert not findings(changed(arm(), 'link3', com=[0.3, 0.1, 0.0]))


def test_the_share_that_is_said_is_that_of_the_number():
    [found] = findings(changed(arm(), 'link5', com=[0.0, 0.0, 1.5]))
    assert 'a tenth of that, 0.15 m' in found.effect
