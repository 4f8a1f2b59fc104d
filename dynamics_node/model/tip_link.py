"""The link at the end of an arm: the default of requests without a link."""

import re

import numpy as np

from .tree import KinematicTree
from ..urdf import RobotDescription

# Largest mass of a branch of fingers, relative to the bodies that carry it.
_LIGHT = 0.05
# The same for a single finger, which its name must confirm.
_LIGHT_FINGER = 0.1
# Names of joints that move fingers; links of these names may be a whole gripper on a wrist.
_FINGER_JOINT = re.compile(r'finger|jaw|gripper|thumb|claw', re.IGNORECASE)
# Names of wrist joints, which are no finger joints.
_WRIST = re.compile(r'yaw|pitch|roll|wrist', re.IGNORECASE)
# Names of fingers, for joints and links.
_DIGIT = re.compile(r'finger|jaw|thumb|claw', re.IGNORECASE)
# Names of tool frames, the best first: tool center, tool, hand.
_TOOLS = (
    re.compile(r'tcp|tool_?cent', re.IGNORECASE),
    re.compile(r'tool', re.IGNORECASE),
    re.compile(r'hand|gripper|palm|eef|effector|(^|_)ee($|_)|flange', re.IGNORECASE),
)


def tip_link(tree: KinematicTree, description: RobotDescription) -> str:
    """
    Return the link at the end of the arm: the last one before the fingers of a hand.

    The walk along the moving bodies follows the heavier branch and ends before branches that are
    light compared with the bodies from the base to there. Among the links of the last body, the
    choice is, in this order: a link at the end of a chain of fixed joints with the name of a tool
    center, a tool or a hand; any link with such a name; the last link.

    Parameters
    ----------
    tree : KinematicTree
    description : RobotDescription
        Description of the same robot.

    Returns
    -------
    str
        The root link if the robot has no movable joint.

    """
    body = _last_body(tree, {joint.name: joint.child for joint in description.joints})
    if body < 0:
        return tree.root
    links = [link for link, frame in tree.links.items() if frame.body == body]
    # Fingers may be fixed to the hand.
    links = [link for link in links if not _DIGIT.search(link)] or links
    inner = {
        joint.parent
        for joint in description.joints
        if not joint.is_movable and not _DIGIT.search(joint.child)
    }
    for choice in ([link for link in links if link not in inner], links):
        for pattern in _TOOLS:
            named = [link for link in choice if pattern.search(link)]
            if named:
                return named[-1]
    return links[-1]


def _last_body(tree: KinematicTree, child: dict[str, str]) -> int:
    # kg: each body with all bodies that it carries.
    behind = np.array(tree.inertia[:, 3, 3])
    for body in range(len(tree.parent) - 1, -1, -1):
        if tree.parent[body] >= 0:
            behind[tree.parent[body]] += behind[body]
    body, before = -1, 0.0  # before: mass from the base to here, kg
    while True:
        children = np.flatnonzero(tree.parent == body)
        if len(children) == 0:
            return body
        heaviest = int(children[np.argmax(behind[children])])
        is_branch = len(children) > 1 and behind[heaviest] < _LIGHT * before
        # Only the names of the joint and its child link count: a wrist may carry a fixed finger.
        # <= : a robot without masses has fingers, too.
        name = tree.moving_joint_names[heaviest]
        is_finger = behind[heaviest] <= _LIGHT_FINGER * before and _is_finger(name, child[name])
        if body >= 0 and (is_branch or is_finger):
            return body
        body, before = heaviest, before + float(tree.inertia[heaviest, 3, 3])


def _is_finger(joint: str, link: str) -> bool:
    if _DIGIT.search(joint) or _DIGIT.search(link):
        return True
    return bool(_FINGER_JOINT.search(joint)) and not _WRIST.search(joint)
