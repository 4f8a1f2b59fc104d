"""Every kind of finding: its stable name, its possible severities and its meaning."""

PROBLEM, WARNING, NOTE = 'problem', 'warning', 'note'

# Possible severities and meaning by kind, in the order of docs/report.md.
KINDS: dict[str, tuple[tuple[str, ...], str]] = {
    'refused': ((PROBLEM,), 'the description cannot be used at all'),
    'negative_mass': ((PROBLEM,), 'a mass below zero'),
    'impossible_inertia': ((PROBLEM, NOTE), 'a tensor that is not positive definite'),
    'no_inertial': ((PROBLEM,), 'no moving link has a mass'),
    'joint_moves_nothing': ((PROBLEM,), 'a joint beyond which there is no inertia'),
    'shape_without_mass': ((WARNING, NOTE), 'a moving link with a shape but without mass'),
    'grams': ((WARNING,), 'a link far lighter than its neighbors or than its inertia suggests'),
    'triangle_inequality': (
        (PROBLEM, NOTE),
        'physically impossible principal moments, often a missing decimal point',
    ),
    'inertia_too_large': ((WARNING,), 'moments far too large for the mass and the size'),
    'tensor_not_about_com': ((WARNING, NOTE), 'a tensor that seems to be about the link frame'),
    'placeholder_tensor': ((WARNING, NOTE), 'a tensor of 1, 1e-3, 1e-6..., or of zero'),
    'placeholder_mass': ((WARNING, NOTE), 'several masses of exactly 1 kg'),
    'identical_inertials': ((WARNING, NOTE), 'one `<inertial>` copied along a chain'),
    'com_at_joint': ((NOTE,), 'a heavy link balanced exactly on its joint'),
    'far_com': ((WARNING,), 'a center of mass outside the robot'),
    'missing_gripper': ((WARNING, NOTE), 'a chain that ends without a tool with a mass'),
    'over_effort_limit': ((WARNING,), 'gravity alone takes more than the effort limit'),
    'no_effort_limit': ((WARNING, NOTE), 'a joint without effort limit'),
    'zero_effort_limit': ((WARNING, NOTE), 'an effort limit of 0 or below'),
    'effort_limit_too_large': (
        (WARNING, NOTE),
        'an effort limit that exceeds any motor of this robot',
    ),
    'limits_in_degrees': ((WARNING,), 'position limits of many turns, as if in degrees'),
    'no_velocity_limit': ((NOTE,), 'a joint without velocity limit'),
    'empty_range': ((WARNING,), 'lower and upper limit are equal or exchanged'),
    'not_looked_at': ((NOTE,), 'a prismatic joint without limits'),
    'missing_axis': ((WARNING,), 'no `<axis>`: the x axis is used'),
    'axis_length': ((NOTE,), 'an axis that is not a unit vector'),
    'negative_friction': ((WARNING,), 'damping or friction below zero'),
    'reader_warning': ((WARNING,), 'any other accepted but suspicious input'),
    'singular_mass_matrix': ((PROBLEM,), 'D is not positive definite'),
    'ill_conditioned': ((NOTE,), 'D can hardly be inverted'),
    'no_movable_joint': ((NOTE,), 'nothing moves'),
}
