"""docs/accuracy.md says what the sweep finds."""

import pytest
from support.accuracy_document import PATH, render
from support.document_check import misfits


@pytest.fixture(scope='module')
def measured():
    return render()


@pytest.mark.timeout(300)
def test_the_document_is_still_true(measured):
    found = misfits(PATH.read_text(encoding='utf-8'), measured)
    assert not found, '\n'.join([*found, 'look why, then run scripts/write_accuracy.py'])


def test_a_robot_a_reason_or_a_worse_figure_would_be_seen(measured):
    lines = measured.splitlines()
    robot = next(number for number, line in enumerate(lines) if line.startswith('| ur5_robot'))
    reason = next(number for number, line in enumerate(lines) if 'it has no <link>' in line)
    without = lines[:robot] + lines[robot + 1 :]
    other = [*lines[:reason], lines[reason].replace('no <link>', 'no name'), *lines[reason + 1 :]]
    better = [line.replace('e-13', 'e-15') for line in lines]
    for wrong in (without, other, better):
        assert misfits('\n'.join(wrong), measured)
    assert not misfits(measured, measured)
