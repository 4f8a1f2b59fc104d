"""Friction of the joints, and their rotors, against closed forms, MuJoCo and Pinocchio."""

from dynamics_node import ArgumentError, RobotModel
import mujoco
import numpy as np
import pinocchio
import pytest
from support.mujoco_oracle import MujocoOracle
from support.robots import ARM7, public_robot, random_state, random_urdf

TWO_JOINTS = """<robot name="r"><link name="world"/>
<link name="a"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
 iyz="0"/>
</inertial></link>
<link name="b"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0"
 iyz="0"/>
</inertial></link>
<joint name="j" type="continuous"><parent link="world"/><child link="a"/><axis xyz="0 0 1"/>
<dynamics damping="0.7" friction="0.3"/></joint>
<joint name="k" type="continuous"><parent link="world"/><child link="b"/><axis xyz="0 1 0"/>
<dynamics damping="{damping}" friction="0.2"/>{mimic}</joint></robot>"""
INDEPENDENT = TWO_JOINTS.format(damping=0.4, mimic='')
MIMIC = TWO_JOINTS.format(damping=0.4, mimic='<mimic joint="j" multiplier="-2" offset="1"/>')


def test_friction_comes_from_the_urdf():
    robot = RobotModel.from_urdf(INDEPENDENT)
    qd = np.array([0.5, -0.01])
    expected = [0.7 * 0.5 + 0.3 * np.tanh(0.5 / 0.05), 0.4 * -0.01 + 0.2 * np.tanh(-0.01 / 0.05)]
    assert robot.friction_torque(qd) == pytest.approx(expected, rel=1e-15)
    assert not RobotModel.from_urdf(ARM7).friction.coulomb.any()


def test_fast_joints_lose_the_power_that_mujoco_takes_by_damping():
    text = INDEPENDENT.replace('friction="0.3"', '').replace('friction="0.2"', '')
    model = mujoco.MjModel.from_xml_string(text)
    data = mujoco.MjData(model)
    robot = RobotModel.from_urdf(text)
    data.qvel[:] = [3.0, -4.0]
    mujoco.mj_forward(model, data)
    assert robot.friction_torque(data.qvel) == pytest.approx(-data.qfrc_passive, rel=1e-14)


def test_a_leader_feels_the_friction_of_the_joint_that_mimics_it():
    robot = RobotModel.from_urdf(MIMIC)
    both = RobotModel.from_urdf(INDEPENDENT)
    qd = 3.0  # fast enough for the hyperbolic tangent to be 1
    power = both.friction_torque([qd, -2.0 * qd]) @ [qd, -2.0 * qd]
    assert robot.friction_torque([qd])[0] * qd == pytest.approx(power, rel=1e-14)


def test_each_friction_parameter_can_be_replaced_alone():
    robot = RobotModel.from_urdf(INDEPENDENT)
    qd = np.array([[0.5, -0.2], [0.0, 0.03]])
    other = robot.with_friction(coulomb=[1.0, 2.0]).with_friction(smoothing_velocity=0.1)
    expected = [0.7, 0.4] * qd + [1.0, 2.0] * np.tanh(qd / 0.1)
    assert other.friction_torque(qd) == pytest.approx(expected, rel=1e-15)
    assert other.with_friction(viscous=0.0).friction_torque(qd) == pytest.approx(
        [1.0, 2.0] * np.tanh(qd / 0.1), rel=1e-15
    )
    # Under another gravity it is the same robot.
    assert other.with_gravity((0, 0, 0)).friction is other.friction


def test_friction_is_not_part_of_the_equation_of_motion():
    robot = RobotModel.from_urdf(INDEPENDENT)
    q, qd = np.zeros(2), np.ones(2)
    assert np.array_equal(
        robot.inverse_dynamics(q, qd, q),
        robot.with_friction(viscous=9.0).inverse_dynamics(q, qd, q),
    )


@pytest.mark.parametrize(
    ('numbers', 'message'),
    [
        ({'viscous': [1.0]}, r'viscous: expected one number, or 2 for j, k; got shape \(1,\)'),
        ({'coulomb': [1.0, -1.0]}, 'coulomb: expected finite numbers >= 0'),
        ({'coulomb': np.nan}, 'coulomb: expected finite'),
        ({'viscous': 'much'}, 'viscous: expected'),
        ({'smoothing_velocity': 0.0}, 'smoothing_velocity: expected numbers > 0'),
    ],
)
def test_wrong_numbers_are_refused(numbers, message):
    with pytest.raises(ArgumentError, match=message):
        RobotModel.from_urdf(INDEPENDENT).with_friction(**numbers)


def test_negative_friction_of_a_urdf_becomes_zero_with_a_warning():
    robot = RobotModel.from_urdf(INDEPENDENT.replace('damping="0.7"', 'damping="-0.7"'))
    assert robot.friction.viscous.tolist() == [0.0, 0.4]
    assert any("joint 'j': damping is -0.7" in warning for warning in robot.warnings)


# Rotors ------------------------------------------------------------------------------------


@pytest.mark.parametrize('seed', range(4))
def test_rotor_inertia_is_the_armature_of_pinocchio_and_mujoco(seed):
    text = random_urdf(seed, with_mimic=False)
    rng = np.random.default_rng(seed)
    plain = RobotModel.from_urdf(text)
    q, qd = random_state(rng, plain)
    qdd, rotors = rng.normal(size=q.size), rng.uniform(0.0, 2.0, q.size)
    robot = plain.with_rotor_inertia(rotors)
    model = pinocchio.buildModelFromXML(text)
    x, order = pinocchio.neutral(model), []
    for i, name in enumerate(robot.joint_names):
        joint = model.joints[model.getJointId(name)]
        order.append(joint.idx_v)
        if joint.nq == 2:
            x[joint.idx_q : joint.idx_q + 2] = np.cos(q[i]), np.sin(q[i])
        else:
            x[joint.idx_q] = q[i]
    model.armature[order] = rotors
    data, v, a = model.createData(), np.empty(q.size), np.empty(q.size)
    v[order], a[order] = qd, qdd
    D = pinocchio.crba(model, data, x)
    D = (np.triu(D) + np.triu(D, 1).T)[np.ix_(order, order)]
    scale = 1e-11 * np.abs(D).max()
    assert robot.mass_matrix(q) == pytest.approx(D, abs=scale)
    tau = pinocchio.rnea(model, data, x, v, a)[order]
    assert robot.inverse_dynamics(q, qd, qdd) == pytest.approx(tau, abs=1e-11 * abs(tau).max())
    assert robot.forward_dynamics(q, qd, tau) == pytest.approx(qdd, abs=1e-9 * abs(qdd).max())
    assert robot.kinetic_energy(q, qd) == pytest.approx(0.5 * qd @ D @ qd, rel=1e-11)
    assert np.array_equal(robot.coriolis_matrix(q, qd), plain.coriolis_matrix(q, qd))
    assert np.array_equal(robot.gravity_torque(q), plain.gravity_torque(q))


def test_rotors_against_mujoco_and_back_to_none():
    text, oracle = ARM7.read_text(), MujocoOracle(ARM7.read_text())
    rotors = np.linspace(0.1, 0.8, 8)
    plain = RobotModel.from_urdf(text)
    robot = plain.with_rotor_inertia(rotors)
    q = np.linspace(-1.0, 1.0, 8)
    assert robot.mass_matrix(q) - plain.mass_matrix(q) == pytest.approx(np.diag(rotors), abs=1e-14)
    for name, rotor in zip(robot.joint_names, rotors, strict=True):
        oracle.model.dof_armature[oracle.model.joint(name).dofadr] = rotor
    expected, _, _ = oracle.dynamics(robot.joint_names, q, q)
    assert robot.mass_matrix(q) == pytest.approx(expected, abs=1e-12)
    # The leader of a mimic joint has a rotor, the joint that follows it has none of its own.
    mimic = RobotModel.from_urdf(MIMIC)
    assert mimic.with_rotor_inertia(0.5).mass_matrix([0.0])[0, 0] == pytest.approx(
        mimic.mass_matrix([0.0])[0, 0] + 0.5
    )
    back = robot.with_rotor_inertia(0.0)
    assert np.array_equal(back.mass_matrix(q), plain.mass_matrix(q))
    with pytest.raises(ArgumentError, match='rotor_inertia: expected one number, or 8'):
        plain.with_rotor_inertia([1.0])


def test_rotors_and_payload_together_on_a_public_robot():
    robot = RobotModel.from_urdf(public_robot('panda_description/urdf/panda.urdf'))
    n = len(robot.joint_names)
    q = np.full(n, 0.3)
    loaded = robot.with_payload('panda_hand', 1.5, (0.0, 0.0, 0.1))
    assert loaded.with_rotor_inertia(0.2).mass_matrix(q) == pytest.approx(
        loaded.mass_matrix(q) + 0.2 * np.eye(n), abs=1e-14
    )
