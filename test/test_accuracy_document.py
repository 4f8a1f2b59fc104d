"""docs/accuracy.md agrees with current measurements."""

import pytest
from support.accuracy_document import PATH, render
from support.document_check import misfits


@pytest.fixture(scope='module')
def measured():
    return render()


@pytest.mark.timeout(300)
def test_the_document_is_true(measured):
    differences = misfits(PATH.read_text(encoding='utf-8'), measured)
    assert not differences, '\n'.join(
        [*differences, 'look why, then run scripts/write_accuracy.py']
    )


def test_a_missing_robot_another_reason_and_a_worse_figure_are_detected(measured):
    lines = measured.splitlines()
    robot = next(number for number, line in enumerate(lines) if line.startswith('| ur5_robot'))
    reason = next(number for number, line in enumerate(lines) if 'it has no <link>' in line)
    without = lines[:robot] + lines[robot + 1 :]
    other = [*lines[:reason], lines[reason].replace('no <link>', 'no name'), *lines[reason + 1 :]]
    better = [line.replace('e-13', 'e-15') for line in lines]
    for wrong in (without, other, better):
        assert misfits('\n'.join(wrong), measured)
    assert not misfits(measured, measured)
