"""Inertial parameters typed to fill a gap."""

from dynamics_node.report import make_report
import pytest
from support.arms import arm, changed, rod


def findings(text, kind):
    """Return the findings of a kind."""
    return [finding for finding in make_report(text, samples=300).findings if finding.kind == kind]


@pytest.mark.parametrize('value', [1.0, 1e-6, 1e-9])
def test_a_placeholder_tensor_is_found(value):
    found = findings(changed(arm(), 'link3', tensor=value), 'placeholder_tensor')
    assert [finding.subjects for finding in found] == [('link3',)]
    assert found[0].severity == 'warning' and '(D_jj)' in found[0].effect


def test_no_tensor_at_all_is_a_note():
    [found] = findings(changed(arm(), 'link3', tensor=0.0), 'placeholder_tensor')
    assert found.severity == 'note' and 'no inertia' in found.what


def test_one_kilogram_and_a_tensor_of_1e_3_are_a_warning():
    # The tensor alone would be a likely one.
    text = changed(changed(arm(), 'link4', tensor=1e-3), 'link4', mass=1.0)
    [found] = findings(text, 'placeholder_tensor')
    assert found.severity == 'warning' and 'exactly 1 kg' in found.what


def test_several_masses_of_one_kilogram_are_told_with_what_two_would_do():
    text = changed(changed(arm(), 'link4', mass=1.0), 'link3', mass=1.0)
    [found] = findings(text, 'placeholder_mass')
    assert (found.severity, found.subjects) == ('note', ('link3', 'link4'))
    assert 'if each of them weighed 2 kg' in found.effect
    assert not findings(changed(arm(), 'link4', mass=1.0), 'placeholder_mass')


def test_one_inertial_copied_along_a_chain_is_found():
    text = arm(masses=(2.0,) * 5, lengths=(0.3, 0.2, 0.25, 0.15, 0.1))
    for link, length in (('link1', 0.3), ('link2', 0.2), ('link3', 0.25)):
        text = text.replace(rod(2.0, length), rod(2.0, 0.3))
        assert link in text
    [found] = findings(text, 'identical_inertials')
    assert found.subjects == ('link1', 'link2', 'link3')
    # Of the three the last matters most; the first turns about the vertical.
    assert "if 'link3' weighed twice as much" in found.effect


def test_equal_modules_are_no_copies():
    text = arm(masses=(2.0,) * 5, lengths=(0.3,) * 5)
    # The first is at another distance from the base, the others are equal parts.
    assert not findings(text.replace('xyz="0.1 0 0"', 'xyz="0.3 0 0"'), 'identical_inertials')


def test_a_heavy_link_balanced_on_its_joint_is_a_note():
    [found] = findings(changed(arm(), 'link2', com=[0.0, 0.0, 0.0]), 'com_at_joint')
    assert (found.severity, found.subjects) == ('note', ('link2',))
    assert "halfway to joint 'joint3'" in found.effect and '+' in found.effect
