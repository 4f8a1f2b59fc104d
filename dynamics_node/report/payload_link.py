"""Which link carries a payload if nobody says it."""

import re

import numpy as np

# Branches lighter than this share of all that moves are fingers; a finger that has no other
# beside it is known by its name, too, and may be heavier.
_LIGHT, _LIGHT_FINGER = 0.05, 0.1
_FINGER = re.compile(r'finger|jaw|gripper|thumb|claw', re.IGNORECASE)
_DIGIT = re.compile(r'finger|jaw|thumb|claw', re.IGNORECASE)
# Names of frames at which tools are meant to be, the best first.
_TOOLS = (re.compile(r'tcp|tool_?cent', re.IGNORECASE), re.compile(r'tool', re.IGNORECASE),
          re.compile(r'hand|gripper|palm|eef|effector|(^|_)ee($|_)|flange', re.IGNORECASE))


def default_payload_link(tree, description):
    """
    Return the link at the end of the arm: the last one before the fingers of a hand.

    The walk along the moving bodies follows the heavier branch and ends where only light ones
    are left. Of the links of that body it takes one in which a chain of fixed joints ends and
    that is called a tool centre, a tool or a hand; if there is none, one that is called so; and
    if there is none, the last.

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
    body = _last_body(tree)
    if body < 0:
        return tree.root
    links = [link for link, frame in tree.links.items() if frame.body == body]
    # Fingers may be fixed, too.
    links = [link for link in links if not _DIGIT.search(link)] or links
    inner = {joint.parent for joint in description.joints
             if not joint.is_movable and not _DIGIT.search(joint.child)}
    for choice in ([link for link in links if link not in inner], links):
        for pattern in _TOOLS:
            named = [link for link in choice if pattern.search(link)]
            if named:
                return named[-1]
    return links[-1]


def _last_body(tree):
    behind = np.array(tree.inertia[:, 3, 3])
    for body in range(len(tree.parent) - 1, -1, -1):
        if tree.parent[body] >= 0:
            behind[tree.parent[body]] += behind[body]
    total = float(tree.inertia[:, 3, 3].sum())
    body = -1
    while True:
        children = np.flatnonzero(tree.parent == body)
        if len(children) == 0:
            return body
        heaviest = int(children[np.argmax(behind[children])])
        if body >= 0 and ((len(children) > 1 and behind[heaviest] < _LIGHT * total)
                          or _is_finger(tree, heaviest, behind, total)):
            return body
        body = heaviest


def _is_finger(tree, body, behind, total):
    links = [link for link, frame in tree.links.items() if frame.body == body]
    return bool(behind[body] < _LIGHT_FINGER * total and (
        _FINGER.search(tree.body_names[body]) or any(map(_FINGER.search, links))))
