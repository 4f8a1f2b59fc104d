"""The first screen of the page."""

from dynamics_node.report.formatting import count, number, percent, quantity
from support.page_reader import plain, reading
from support.report_pages import arm7_report, refused_report, unlimited_report, weak_report


def test_the_first_screen_has_the_numbers_that_matter_most():
    report = weak_report()
    words = reading(weak_report).words
    worst = max(
        (joint for joint in report.joints if joint.gravity is not None),
        key=lambda joint: joint.gravity.share,
    )
    for said in (
        f'mass {number(report.total_mass)} kg',
        f'{quantity(report.moving_mass, "kg")} of it moves',
        f'largest share of an effort limit {percent(worst.gravity.share)}',
        f'payload at every pose {number(report.payload.everywhere, 3)} kg',
        f'{number(report.conditioning.median, 3)} worst {number(report.conditioning.worst, 3)}',
    ):
        assert plain(said) in words


def test_the_badge_says_how_bad_it_is():
    assert 'arm7 usable 8 joints' in reading(arm7_report).words
    assert 'refused refused 2 joints' in reading(refused_report).words
    counts = weak_report().counts
    said = (
        f'not to be trusted: {count(counts["problem"], "problem")}'
        if counts['problem']
        else f'usable, with {count(counts["warning"], "warning")}'
    )
    assert said in reading(weak_report).words


def test_without_limits_the_torque_itself_is_shown():
    words = reading(unlimited_report).words
    worst = max(
        joint.gravity.magnitude for joint in unlimited_report().joints if joint.gravity is not None
    )
    assert f'worst gravity torque {number(worst, 3)} N m' in words
    assert 'payload at every pose – no effort limit is in the way' in words
