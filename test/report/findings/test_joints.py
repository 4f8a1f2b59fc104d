"""What the reader has put in order."""

from dynamics_node.report import make_report
from support.arms import arm, changed


def findings(text, kind):
    """Return the findings of a kind."""
    return [finding for finding in make_report(text, samples=300).findings if finding.kind == kind]


def test_a_missing_axis_is_told_with_the_torque_about_z():
    # Joint 1 turns about z, and about x without its axis: lying on its side it holds the arm.
    text = changed(arm(), 'joint1', axis=False)
    [found] = findings(text, 'missing_axis')
    assert (found.severity, found.subjects) == ('warning', ('joint1',))
    right = make_report(text.replace('type="revolute"', 'type="revolute"'), samples=300)
    magnitude = right.joints[0].gravity.magnitude
    assert f'is {magnitude:.3g} N m; with the z axis it would be 0 N m' in found.effect


def test_an_axis_that_is_no_unit_vector_is_a_note():
    [found] = findings(arm().replace('xyz="1 0 0"', 'xyz="2 0 0"'), 'axis_length')
    assert (found.severity, found.subjects) == ('note', ('joint5',))


def test_negative_friction_is_a_warning():
    text = arm().replace('</joint>', '<dynamics damping="-1" friction="-2"/></joint>', 1)
    [found] = findings(text, 'negative_friction')
    assert (found.severity, found.subjects) == ('warning', ('joint1',))
    assert 'damping is -1' in found.what and 'friction is -2' in found.what


def test_nothing_moves_is_a_note():
    report = make_report('<robot name="stone"><link name="a"/></robot>')
    assert [finding.kind for finding in report.findings] == ['no_movable_joint']
    assert report.payload is None and report.conditioning is None


def test_every_warning_of_the_model_is_in_the_report():
    text = changed(changed(arm(), 'joint1', axis=False), 'link5', tensor={'ixx': 0.5})
    text = changed(text.replace('xyz="1 0 0"', 'xyz="2 0 0"'), 'link2', inertial=False)
    text = text.replace('</joint>', '<dynamics damping="-1"/></joint>', 1)
    report = make_report(text, samples=100)
    assert len(report.model.warnings) == 5
    kinds = {finding.kind for finding in report.findings}
    assert kinds >= {
        'missing_axis',
        'axis_length',
        'negative_friction',
        'triangle_inequality',
        'shape_without_mass',
    }
    assert 'reader_warning' not in kinds


def test_a_warning_that_nobody_knows_is_told_as_it_is(monkeypatch):
    from dynamics_node.report.findings import joints

    monkeypatch.setattr(joints, '_EXPLAINED', ())
    [found] = findings(changed(arm(), 'joint1', axis=False), 'reader_warning')
    assert found.what == "joint 'joint1': axis is missing, (1, 0, 0) is used"
