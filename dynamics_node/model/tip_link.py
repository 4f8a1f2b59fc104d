"""The link at the end of an arm, which requests mean that name none."""

import re

import numpy as np

# Branches lighter than this share of what carries them are fingers; a finger that has no other
# beside it is known by its name, too, and may be heavier.
_LIGHT, _LIGHT_FINGER = 0.05, 0.1
# A joint of this name moves a finger; a link of this name may be a whole gripper on a wrist.
_FINGER_JOINT = re.compile(r'finger|jaw|gripper|thumb|claw', re.IGNORECASE)
# Unless it is a wrist.
_WRIST = re.compile(r'yaw|pitch|roll|wrist', re.IGNORECASE)
_DIGIT = re.compile(r'finger|jaw|thumb|claw', re.IGNORECASE)
# Names of frames at which tools are meant to be, the best first.
_TOOLS = (
    re.compile(r'tcp|tool_?cent', re.IGNORECASE),
    re.compile(r'tool', re.IGNORECASE),
    re.compile(r'hand|gripper|palm|eef|effector|(^|_)ee($|_)|flange', re.IGNORECASE),
)


def tip_link(tree, description):
    """
    Return the link at the end of the arm: the last one before the fingers of a hand.

    The walk along the moving bodies follows the heavier branch and ends where only light ones
    are left, compared with the bodies from the base to there. Of the links of that body it takes
    one in which a chain of fixed joints ends and that is called a tool center, a tool or a hand;
    if there is none, one that is called so; and if there is none, the last.

    Parameters
    ----------
    tree : KinematicTree
    description : RobotDescription
        Of the same robot.

    Returns
    -------
    str
        The root link if nothing moves.

    """
    body = _last_body(tree, {joint.name: joint.child for joint in description.joints})
    if body < 0:
        return tree.root
    links = [link for link, frame in tree.links.items() if frame.body == body]
    # Fingers may be fixed, too.
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


def _last_body(tree, child):
    behind = np.array(tree.inertia[:, 3, 3])
    for body in range(len(tree.parent) - 1, -1, -1):
        if tree.parent[body] >= 0:
            behind[tree.parent[body]] += behind[body]
    body, before = -1, 0.0
    while True:
        children = np.flatnonzero(tree.parent == body)
        if len(children) == 0:
            return body
        heaviest = int(children[np.argmax(behind[children])])
        is_branch = len(children) > 1 and behind[heaviest] < _LIGHT * before
        # Its own names count: what is fixed to a wrist may be called finger, too. A robot that
        # weighs nothing has fingers as well.
        name = tree.moving_joint_names[heaviest]
        is_finger = behind[heaviest] <= _LIGHT_FINGER * before and _is_finger(name, child[name])
        if body >= 0 and (is_branch or is_finger):
            return body
        body, before = heaviest, before + float(tree.inertia[heaviest, 3, 3])


def _is_finger(joint, link):
    if _DIGIT.search(joint) or _DIGIT.search(link):
        return True
    return bool(_FINGER_JOINT.search(joint)) and not _WRIST.search(joint)
