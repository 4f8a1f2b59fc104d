"""Points and joints over their limits, and the largest payload."""

from dynamics_node import ArgumentError, RobotModel
from dynamics_node.dynamics import over_limit
from hypothesis import given
from hypothesis import strategies as st
import numpy as np
import pinocchio
import pytest
from support.pinocchio_oracle import PinocchioOracle
from support.robots import ARM7, random_urdf


def test_points_and_joints_over_their_limits_are_named():
    efforts = [[1.0, -5.0, 0.0], [2.0, 4.0, 9.0], [-3.0, 1.0, 0.0]]
    over = over_limit(efforts, [2.5, 4.5, NAN])
    assert over.points.tolist() == [0, 2]
    assert over.joints.tolist() == [0, 1]
    assert over.peak_effort.tolist() == [3.0, 5.0, 9.0]


def test_an_effort_at_its_limit_is_allowed_and_the_next_number_is_not():
    assert over_limit([[2.0], [-2.0]], [2.0]).points.tolist() == []
    assert over_limit([[2.0], [np.nextafter(-2.0, -3.0)]], [2.0]).points.tolist() == [1]


def test_joints_without_a_limit_are_never_over():
    over = over_limit([[1e300, 1.0]], [NAN, 2.0])
    assert over.points.tolist() == over.joints.tolist() == []


def test_nan_is_over_every_limit():
    assert over_limit([[NAN]], [1.0]).points.tolist() == [0]


@pytest.mark.parametrize(
    ('efforts', 'limits', 'text'),
    [
        ([1.0], [1.0], r'efforts: expected shape \(N, n\) with at least one point, got \(1,\)'),
        (np.zeros((0, 1)), [1.0], r'at least one point, got \(0, 1\)'),
        ([[1.0]], [1.0, 2.0], r'effort limits: expected shape \(1,\), one per joint, got \(2,\)'),
        (
            [[1.0, 1.0]],
            [1.0, -2.0],
            'effort limits: joint 1: expected at least 0, or NaN for none, got -2.0',
        ),
    ],
)
def test_over_limit_refuses_wrong_input(efforts, limits, text):
    with pytest.raises(ArgumentError, match=text):
        over_limit(efforts, limits)


NAN, INF = float('nan'), float('inf')
M, LENGTH, G = 3.0, 0.7, 9.81
LIMIT = 20.0
# A mast that turns about the vertical and a carriage that is lifted on it.
LIFT = """
<robot name="lift"><link name="base"/><link name="mast"><inertial><mass value="9"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="turn" type="revolute"><parent link="base"/><child link="mast"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="50" velocity="1"/></joint>
<link name="fork"><inertial><mass value="2"/>
<inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/></inertial></link>
<joint name="lift" type="prismatic"><parent link="mast"/><child link="fork"/>
<origin xyz="0.3 0.1 0.2"/><axis xyz="0 0 1"/>
<limit lower="0" upper="2" effort="120" velocity="1"/></joint>
<link name="pallet"/><joint name="tines" type="fixed"><parent link="fork"/><child link="pallet"/>
<origin xyz="0.4 0 0" rpy="0 0 1.5707963267948966"/></joint></robot>"""


@pytest.fixture(scope='module')
def pendulum():
    return RobotModel.from_urdf(ARM7.with_name('pendulum.urdf'))


@pytest.fixture(scope='module')
def lift():
    return RobotModel.from_urdf(LIFT)


@pytest.fixture(scope='module')
def arm():
    return RobotModel.from_urdf(ARM7)


# Closed forms -------------------------------------------------------------------------------


@pytest.mark.parametrize('angle', [0.0, 0.4, -1.2, 2.9])
def test_a_pendulum_carries_the_remaining_torque(pendulum, angle):
    # cos q (M g l/2 + m g l) = limit, at the far end.
    mass, joint = pendulum.max_payload([angle], 'rod')
    assert mass == pytest.approx(
        (LIMIT / abs(np.cos(angle)) - M * G * LENGTH / 2) / (G * LENGTH), rel=1e-13
    )
    assert joint == 0
    nearer = pendulum.max_payload([angle], 'rod', (-0.3, 0.0, 0.0)).mass
    assert nearer == pytest.approx(mass * LENGTH / (LENGTH - 0.3), rel=1e-13)
    assert pendulum.max_payload([angle], 'hub', (0.4, 0.0, 0.0)).mass == pytest.approx(
        nearer, rel=1e-13
    )


def test_payload_of_a_tilted_pendulum_follows_gravity(pendulum):
    # Mounted on a wall, with g along the axis: no torque. Turned by 30 degrees about
    # the axis: as if the pendulum were elsewhere.
    wall = pendulum.with_gravity((0.0, G, 0.0)).max_payload([0.3], 'rod')
    assert (wall.mass, wall.joint) == (INF, -1)
    turned = pendulum.with_gravity((-G * np.sin(0.5), 0.0, -G * np.cos(0.5)))
    assert turned.max_payload([0.3], 'rod').mass == pytest.approx(
        float(pendulum.max_payload([0.8], 'rod').mass), rel=1e-12
    )
    ceiling = pendulum.with_gravity((0.0, 0.0, G)).max_payload([0.3], 'rod').mass
    assert ceiling == pytest.approx(float(pendulum.max_payload([0.3], 'rod').mass), rel=1e-13)


def test_a_fork_lifts_its_force_and_less_while_it_accelerates(lift):
    mass, joint = lift.max_payload([0.4, 1.0], 'pallet')
    assert mass == pytest.approx(120.0 / G - 2.0, rel=1e-13)
    assert lift.joint_names[joint] == 'lift'
    rising = lift.max_payload([0.4, 1.0], 'pallet', qdd=[0.0, 2.5]).mass
    assert rising == pytest.approx(120.0 / (G + 2.5) - 2.0, rel=1e-13)


def test_speeding_up_a_mast_takes_its_torque(lift):
    # (I + m r²) alpha, with r from the mast's axis to the pallet.
    alpha, inertia = 20.0, 2.0 + 2.0 * (0.3**2 + 0.1**2)
    mass, joint = lift.max_payload(
        [0.0, 1.0], 'pallet', qdd=[alpha, 0.0], effort_limits=[50.0, NAN]
    )
    assert mass == pytest.approx((50.0 / alpha - inertia) / (0.7**2 + 0.1**2), rel=1e-12)
    assert joint == 0


def test_velocities_reduce_the_payload():
    # A slide on a turning mast holds the centrifugal force (M x + m X) w².
    slide = RobotModel.from_urdf(
        LIFT.replace(
            '<axis xyz="0 0 1"/>\n<limit lower="0"', '<axis xyz="1 0 0"/>\n<limit lower="0"'
        )
    )
    w, position = 4.0, 0.5
    mass, joint = slide.max_payload([0.2, position], 'pallet', qd=[w, 0.0])
    assert mass == pytest.approx(
        (120.0 / w**2 - 2.0 * (0.3 + position)) / (0.7 + position), rel=1e-12
    )
    assert joint == 1
    assert slide.max_payload([0.2, position], 'pallet').mass == INF


def test_an_axis_along_gravity_does_not_limit_the_payload(lift):
    # Only rounding pulls at the mast. That must not become 1e17 kg.
    for angle in np.linspace(-3.0, 3.0, 200):
        result = lift.max_payload([angle, 0.7], 'pallet', effort_limits=[1e-9, NAN])
        assert (result.mass, result.joint) == (INF, -1)


def test_a_payload_on_the_joint_axis_is_unlimited():
    arm = RobotModel.from_urdf(ARM7)
    rng = np.random.default_rng(4)
    point = np.linalg.inv(arm.tree.links['shoulder'].placement) @ [0.0, 0.0, 0.2, 1.0]
    result = arm.max_payload(rng.uniform(-1, 1, (50, 8)), 'shoulder', point[:3])
    assert np.isinf(result.mass).all() and (result.joint == -1).all()


# What limits --------------------------------------------------------------------------------


def test_over_a_limit_it_is_zero_with_the_worst_joint(arm):
    q = np.array([0.0, 1.2, 0.0, 1.0, 0.0, 1.0, 0.0, 0.0])
    torque = np.abs(arm.gravity_torque(q))
    limits = np.full(8, NAN)
    limits[1], limits[3] = torque[1] / 1.1, torque[3] / 1.5
    result = arm.max_payload(q, 'tool_center', effort_limits=limits)
    assert (result.mass, result.joint) == (0.0, 3)
    limits[3] = NAN
    assert arm.max_payload(q, 'tool_center', effort_limits=limits).joint == 1


def test_joints_without_limits_never_limit(arm):
    q = np.array([0.3, 1.2, 0.2, 1.0, 0.1, 1.0, 0.2, 0.0])
    free = arm.max_payload(q, 'tool_center', effort_limits=np.full(8, NAN))
    assert (free.mass, free.joint) == (INF, -1)
    endless = arm.max_payload(q, 'tool_center', effort_limits=np.full(8, INF))
    assert (endless.mass, endless.joint) == (INF, -1)
    first = arm.max_payload(q, 'tool_center')
    limits = arm.effort_limits.copy()
    limits[first.joint] = NAN
    second = arm.max_payload(q, 'tool_center', effort_limits=limits)
    assert second.mass > first.mass and second.joint not in (first.joint, -1)


def test_a_fixed_link_has_unlimited_payload(arm):
    result = arm.max_payload(np.zeros(8), 'base', (1.0, 0.0, 0.0))
    assert (result.mass, result.joint) == (INF, -1)


def test_a_robot_without_joints_has_unlimited_payload():
    result = RobotModel.from_urdf('<robot name="r"><link name="a"/></robot>').max_payload([], 'a')
    assert (result.mass, result.joint) == (INF, -1)


def test_a_higher_limit_allows_more_payload(arm):
    q = np.array([0.3, 1.2, 0.2, 1.0, 0.1, 1.0, 0.2, 0.0])
    less, more = (
        float(arm.max_payload(q, 'tool_center', effort_limits=factor * arm.effort_limits).mass)
        for factor in (1.0, 1.1)
    )
    assert more > less > 0.0


# Against Pinocchio --------------------------------------------------------------------------


def ratio_in_pinocchio(text, gravity, model, state, link, point, mass):
    """Return |effort| / limit of each joint with a point mass added by Pinocchio's own means."""
    oracle = PinocchioOracle(text, gravity)
    frame = oracle.model.frames[oracle.model.getFrameId(link)]
    body = pinocchio.Inertia(float(mass), np.array(point), np.zeros((3, 3)))
    oracle.model.appendBodyToJoint(frame.parentJoint, body, frame.placement)
    oracle.data = oracle.model.createData()
    return np.abs(oracle.inverse_dynamics(model.joint_names, *state)) / model.effort_limits


def assert_at_the_limit(text, model, gravity, state, link, point):
    """Hold one answer against Pinocchio; return it."""
    mass, joint = model.max_payload(state[0], link, point, qd=state[1], qdd=state[2])
    judge = [text, gravity, model, state, link, point]
    if mass == 0.0:
        ratios = ratio_in_pinocchio(*judge, 0.0)
        assert ratios.max() > 1.0 - 1e-9 and ratios.argmax() == joint
    elif np.isinf(mass):
        assert joint == -1
        before, after = ratio_in_pinocchio(*judge, 0.0), ratio_in_pinocchio(*judge, 1e6)
        np.testing.assert_allclose(after, before, rtol=1e-6, atol=1e-6)
    else:
        ratios = ratio_in_pinocchio(*judge, mass)
        assert ratios.max() == pytest.approx(1.0, abs=1e-9) and ratios.argmax() == joint
        assert ratio_in_pinocchio(*judge, 1.001 * mass).max() > 1.0
        assert ratio_in_pinocchio(*judge, 0.5 * mass).max() < 1.0
    return mass, joint


@given(seed=st.integers(0, 2**32 - 1), prismatic=st.sampled_from([0.3, 0.0, 1.0]))
def test_in_pinocchio_the_largest_payload_reaches_the_limit(seed, prismatic):
    rng = np.random.default_rng(seed)
    text = random_urdf(seed, prismatic=prismatic).replace(
        'effort="90"', f'effort="{rng.uniform(5, 900)}"'
    )
    gravity = rng.normal(0.0, 6.0, 3)
    model = RobotModel.from_urdf(text, gravity)
    n = len(model.joint_names)
    state = (rng.uniform(-2.0, 2.0, n), rng.normal(0.0, 0.5, n), rng.normal(0.0, 0.5, n))
    link = list(model.tree.links)[int(rng.integers(len(model.tree.links)))]
    assert_at_the_limit(text, model, gravity, state, link, rng.normal(0.0, 0.3, 3))


def test_arm7_under_tilted_gravity_reaches_its_limit():
    text, gravity = ARM7.read_text(), (3.0, -4.0, -8.0)
    model = RobotModel.from_urdf(text, gravity)
    rng = np.random.default_rng(6)
    limiting = set()
    for _ in range(40):
        state = [*rng.uniform(-1.0, 1.0, (1, 8)), *rng.normal(0.0, 0.3, (2, 8))]
        mass, joint = assert_at_the_limit(
            text, model, gravity, state, 'tool_center', (0.0, 0.02, 0.05)
        )
        assert 0.0 < mass < 100.0
        limiting.add(int(joint))
    assert len(limiting) > 1  # so it is not always the same question


def chain_formula(oracle, model, q, link, gravity):
    """
    Return the payload as dynamics solvers for chains compute it, with Pinocchio's numbers.

    Torques without payload, then those of 1 N upwards along the base's z at the link; the
    largest force that all joints allow, divided by the length of the gravity vector.

    """
    names, limits = list(model.joint_names), model.effort_limits
    without = oracle.dynamics(names, q, np.zeros_like(q))[2]
    B, b = oracle.fold(names)
    x = oracle._configuration(B @ q + b)
    pinocchio.forwardKinematics(oracle.model, oracle.data, x)
    pinocchio.updateFramePlacements(oracle.model, oracle.data)
    J = (
        pinocchio.computeFrameJacobian(
            oracle.model,
            oracle.data,
            x,
            oracle.model.getFrameId(link),
            pinocchio.LOCAL_WORLD_ALIGNED,
        )
        @ B
    )
    torque = J[2]
    with np.errstate(divide='ignore'):
        force = np.maximum((limits - without) / torque, (-limits - without) / torque)
    return force.min() / np.linalg.norm(gravity)


def test_upright_it_agrees_with_chain_solvers_and_tilted_it_does_not():
    # As MoveIt's dynamics_solver::getMaxPayload for an arm on a level floor. (There gravity has to
    # be handed over pointing up: what lifts the load and what pulls at the arm would otherwise
    # have opposite signs in KDL.)
    text = ARM7.read_text()
    rng = np.random.default_rng(8)
    for gravity, same in (((0.0, 0.0, -G), True), ((G, 0.0, 0.0), False)):
        model, oracle = RobotModel.from_urdf(text, gravity), PinocchioOracle(text, gravity)
        for q in rng.uniform(-1.0, 1.0, (10, 8)):
            ours = float(model.max_payload(q, 'tool_center').mass)
            theirs = chain_formula(oracle, model, q, 'tool_center', gravity)
            assert (ours == pytest.approx(theirs, rel=1e-9)) == same


# Batches ------------------------------------------------------------------------------------


def test_a_batch_is_its_states_one_by_one_and_a_trajectory_its_least(arm):
    rng = np.random.default_rng(9)
    q, qd, qdd = rng.uniform(-1, 1, (3, 2, 25, 8))
    result = arm.max_payload(q, 'tool_center', qd=qd, qdd=qdd)
    assert result.mass.shape == result.joint.shape == (2, 25)
    for place in np.ndindex(2, 25):
        one = arm.max_payload(q[place], 'tool_center', qd=qd[place], qdd=qdd[place])
        assert one.mass == pytest.approx(result.mass[place], rel=1e-12)
        assert one.joint == result.joint[place]
    mass, joint, point = result.least()
    assert mass == result.mass.min() == result.mass[point]
    assert joint == result.joint[point]


def test_batch_axes_broadcast_and_an_empty_batch_has_no_least(arm):
    qd = np.random.default_rng(2).normal(size=(4, 8))
    result = arm.max_payload(np.full(8, 0.3), 'tool_center', qd=qd)
    assert result.mass.shape == (4,) and len(set(result.mass)) == 4
    none = arm.max_payload(np.zeros((0, 8)), 'tool_center')
    assert none.mass.shape == none.joint.shape == (0,)
    with pytest.raises(ArgumentError, match='expected at least one state, got none'):
        none.least()


def test_a_nan_position_gives_nan(arm):
    q = np.zeros((3, 8))
    q[1, 2] = NAN
    result = arm.max_payload(q, 'tool_center')
    assert np.isnan(result.mass).tolist() == [False, True, False]
    assert result.joint[1] == -1
    assert np.isnan(result.least()[0])


# Other properties of the model --------------------------------------------------------------


def test_max_payload_replaces_the_payload_of_the_model(arm):
    q = np.array([0.3, 1.2, 0.2, 1.0, 0.1, 1.0, 0.2, 0.0])
    mass, joint = arm.max_payload(q, 'tool_center', (0.0, 0.1, 0.0))
    loaded = arm.with_payload('tool_center', float(mass), (0.0, 0.1, 0.0))
    ratios = np.abs(loaded.gravity_torque(q)) / arm.effort_limits
    assert ratios.max() == pytest.approx(1.0, abs=1e-12) and ratios.argmax() == joint
    assert loaded.max_payload(q, 'tool_center', (0.0, 0.1, 0.0)) == (mass, joint)


def test_rotors_take_their_share_of_an_acceleration(lift):
    heavy = lift.with_rotor_inertia([0.0, 4.0])
    assert heavy.max_payload([0.0, 1.0], 'pallet').mass == pytest.approx(120.0 / G - 2.0)
    assert heavy.max_payload([0.0, 1.0], 'pallet', qdd=[0.0, 2.5]).mass == pytest.approx(
        (120.0 - 2.5 * 4.0) / (G + 2.5) - 2.0
    )


@pytest.mark.parametrize(
    ('arguments', 'options', 'text'),
    [
        (
            ([0.0], 'hook'),
            {},
            "'hook' is not a link of the robot; expected one of world, hub, rod",
        ),
        (([0.0], 'rod', (0.0, 0.0)), {}, r'point: expected three finite numbers in the frame'),
        (([0.0], 'rod', (0.0, NAN, 0.0)), {}, r'point: expected .* got \[0.0, nan, 0.0\]'),
        (([0.0, 1.0], 'rod'), {}, r'q: expected shape \(..., 1\)'),
        (([0.0], 'rod'), {'qd': [0.0, 1.0]}, r'qd: expected shape \(..., 1\)'),
        ((np.zeros((2, 1)), 'rod'), {'qdd': np.zeros((3, 1))}, 'expected batch axes that fit'),
        (([0.0], 'rod'), {'effort_limits': [1.0, 2.0]}, r'effort limits: expected shape \(1,\)'),
        (([0.0], 'rod'), {'effort_limits': [-1.0]}, 'effort limits: joint 0: expected at least 0'),
    ],
)
def test_wrong_input_is_refused_with_expected_and_given_values(pendulum, arguments, options, text):
    with pytest.raises(ArgumentError, match=text):
        pendulum.max_payload(*arguments, **options)


@pytest.mark.parametrize('gravity', [0.0, 1e-310])
def test_without_gravity_the_payload_is_unlimited(pendulum, gravity):
    result = pendulum.with_gravity((0.0, 0.0, -gravity)).max_payload([0.3], 'rod')
    assert (result.mass, result.joint) == (INF, -1)


def test_an_overflowing_point_gives_nan_without_a_warning(arm):
    # Warnings are errors here.
    result = arm.max_payload(np.zeros(8), 'hand', (1e160, 0.0, 0.0))
    assert np.isnan(result.mass) and result.joint == -1
