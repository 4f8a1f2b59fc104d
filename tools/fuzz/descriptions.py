"""Descriptions: robots broken as XML, as text and as bytes; random text and bytes."""

from functools import cache
import random

from hypothesis import strategies as st
from support.robots import ARM7, PENDULUM, random_urdf

from .mutated_bytes import broken
from .mutated_xml import changed_text, changed_tree, grown_text
from .seeds import seeds, siblings

# All elements that dynamics reads, and others that it has to ignore.
EVERYTHING = """<?xml version="1.0"?>
<robot name="everything">
  <material name="m"><texture filename="file:///nowhere/t.png"/></material>
  <link name="base"/>
  <link name="arm">
    <inertial><origin xyz="0 0 0.1" rpy="0.1 0.2 0.3"/><mass value="1.5"/>
      <inertia ixx="0.02" ixy="0.001" ixz="0" iyy="0.03" iyz="0" izz="0.02"/></inertial>
    <visual><geometry><mesh filename="http://localhost:1/a.dae"/></geometry></visual>
    <collision><geometry><mesh filename="../../etc/passwd"/></geometry></collision>
  </link>
  <link name="tool"><inertial><mass value="0.5"/>
    <inertia ixx="0.01" ixy="0" ixz="0" iyy="0.01" iyz="0" izz="0.01"/></inertial></link>
  <link name="finger"/><link name="thumb"/>
  <joint name="shoulder" type="revolute"><parent link="base"/><child link="arm"/>
    <origin xyz="0 0 1" rpy="0 1.57 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="2" effort="30" velocity="2"/>
    <dynamics damping="0.1" friction="0.2"/></joint>
  <joint name="wrist" type="fixed"><parent link="arm"/><child link="tool"/></joint>
  <joint name="slide" type="prismatic"><parent link="tool"/><child link="finger"/>
    <axis xyz="1 0 0"/><limit lower="0.1" upper="0.2" effort="5" velocity="1"/></joint>
  <joint name="follow" type="continuous"><parent link="tool"/><child link="thumb"/>
    <mimic joint="slide" multiplier="-2" offset="0.1"/></joint>
  <transmission name="t"><joint name="shoulder"/></transmission>
  <gazebo reference="arm"><plugin filename="lib.so"><x y="z">0</x></plugin></gazebo>
  <ros2_control name="c" type="system"><joint name="shoulder"/></ros2_control>
</robot>
"""
# Kinds of changes by frequency: most of them preserve XML.
_CHANGES = ('tree',) * 16 + ('text', 'text', 'encoding', 'bytes')
_ENCODINGS = ('utf-8-sig', 'utf-16', 'utf-16-be', 'utf-32', 'latin-1', 'cp1252', 'utf-7')
_DECLARED = ('utf-8', 'utf-16', 'shift_jis', 'utf-7', 'nonsense', '')


@cache
def bases():
    """Return complete robots as text; small ones are frequent, because they are fast."""
    small = [random_urdf(seed, joints=1 + seed % 3) for seed in range(6)]
    return (*[EVERYTHING] * 8, *small, PENDULUM.read_text(), ARM7.read_text())


def descriptions():
    """
    Return a strategy of lists of bytes that may, or may not, describe a robot.

    Hypothesis chooses a robot and a list of seeds, one per change, and shrinks the list of a
    finding. Each change is drawn from its seed: if hypothesis drew every place and value, that
    would take ten times as long as reading the robot.

    """
    ways = {
        -1: seeds(1).map(
            lambda drawn: [grown_text(random.Random(seed)).encode() for (seed,) in siblings(drawn)]
        ),
        -2: st.binary(max_size=200).map(lambda data: [data]),
        -3: st.text(max_size=200).map(lambda text: [text.encode(errors='surrogatepass')]),
    }
    robots = [
        st.builds(
            lambda text, drawn: [_changed(text, each) for each in siblings(drawn)],
            st.just(text),
            seeds(4),
        )
        for text in bases()
    ]
    return st.integers(-3, len(robots) - 1).flatmap(
        lambda way: robots[way] if way >= 0 else ways[way]
    )


def _changed(text, each):
    changes = {kind: [] for kind in _CHANGES}
    for seed in each:
        rng = random.Random(seed)
        changes[rng.choice(_CHANGES)].append(rng)
    # Trees before texts before bytes: only XML can be changed as a tree.
    if changes['tree']:
        text = changed_tree(changes['tree'], text)
    for rng in changes['text']:
        text = changed_text(rng, text)
    data = text.encode(errors='surrogatepass')
    for rng in changes['encoding'][:1]:
        data = _encoded(rng, text)
    for rng in changes['bytes']:
        data = broken(rng, data)
    return data


def _encoded(rng, text):
    encoding = rng.choice(_ENCODINGS)
    declared = rng.choice((encoding, *_DECLARED))
    if declared:
        text = f'<?xml version="1.0" encoding="{declared}"?>' + text.rpartition('?>')[2]
    return text.encode(encoding, errors='replace')
