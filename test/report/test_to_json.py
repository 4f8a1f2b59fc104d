"""The report as JSON."""

import json

from dynamics_node.report import make_report, to_json
import pytest
from support.arms import arm, changed
from support.robots import ARM7


def test_it_is_strict_json_and_comes_again():
    texts = [
        json.dumps(to_json(make_report(ARM7, samples=200)), allow_nan=False) for _ in range(2)
    ]
    assert texts[0] == texts[1]
    plain = json.loads(texts[0])
    assert plain['format'] == 1 and 'model' not in plain
    assert [joint['name'] for joint in plain['joints']][:2] == ['shoulder_yaw', 'shoulder_pitch']
    # Infinite: gravity never loads it, and no mass does.
    assert plain['joints'][0]['gravity']['payload_left'] is None
    assert plain['joints'][1]['gravity']['magnitude'] > 0.0
    assert plain['links'][0]['is_physical'] is True
    assert plain['counts'] == {'problem': 0, 'warning': 0, 'note': 0} and plain['is_clean']


def test_numbers_are_not_rounded():
    report = make_report(ARM7, samples=100)
    plain = to_json(report)
    assert plain['joints'][1]['gravity']['worst'] == report.joints[1].gravity.worst
    assert plain['payload']['everywhere'] == report.payload.everywhere


@pytest.mark.parametrize(
    'text',
    [
        changed(arm(), 'link2', mass=-1.0),
        arm().replace('revolute', 'planar', 1),
        arm(effort='inf'),
        '<robot name="a"><link name="b"/></robot>',
    ],
)
def test_what_is_missing_is_null(text):
    json.dumps(to_json(make_report(text, samples=50)), allow_nan=False)
