"""config/robots/arm7.urdf: written by its generator, physical, able to hold itself."""

import importlib.util
from pathlib import Path
from xml.etree import ElementTree as ET

import numpy as np
import pinocchio
import pytest

ROOT = Path(__file__).resolve().parents[1]
ARM7 = ROOT / 'config' / 'robots' / 'arm7.urdf'


@pytest.fixture(scope='module')
def generator():
    """Return scripts/make_arm7.py as a module."""
    path = ROOT / 'scripts' / 'make_arm7.py'
    spec = importlib.util.spec_from_file_location('make_arm7', path)
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture(scope='module')
def robot():
    """Return the <robot> element."""
    return ET.parse(ARM7).getroot()


@pytest.fixture(scope='module')
def model():
    """Return Pinocchio's model of the arm."""
    return pinocchio.buildModelFromUrdf(str(ARM7))


def inertials(robot):
    """Return (link name, mass, com, inertia in the link's axes) of every link with an inertial."""
    for link in robot.findall('link'):
        inertial = link.find('inertial')
        if inertial is None:
            continue
        get = inertial.find('inertia').get
        tensor = np.array(
            [[float(get('i' + ''.join(sorted(a + b)))) for b in 'xyz'] for a in 'xyz']
        )
        rpy = [float(x) for x in inertial.find('origin').get('rpy').split()]
        turn = pinocchio.rpy.rpyToMatrix(*rpy)
        com = np.array([float(x) for x in inertial.find('origin').get('xyz').split()])
        yield (
            link.get('name'),
            float(inertial.find('mass').get('value')),
            com,
            turn @ tensor @ turn.T,
        )


def test_the_file_is_exactly_what_the_generator_writes(generator):
    assert ARM7.read_text(encoding='utf-8') == generator.arm7_urdf(), (
        'config/robots/arm7.urdf differs from its generator: run python3 scripts/make_arm7.py'
    )


def test_every_inertial_belongs_to_a_possible_body(robot):
    for name, mass, _, tensor in inertials(robot):
        moments = np.linalg.eigvalsh(tensor)
        assert mass > 0 and moments[0] > 0, name
        assert moments[2] <= moments[0] + moments[1], name


def test_every_inertial_is_that_of_its_parts_filled_with_points(generator, robot):
    parts = {link.name: link.parts for link in generator.LINKS}
    for name, mass, com, tensor in inertials(robot):
        points, weights = point_cloud(generator, parts[name])
        assert weights.sum() == pytest.approx(mass, rel=1e-5), name
        assert points.T @ weights / mass == pytest.approx(com, abs=1e-4), name
        away = points - com
        moments = np.einsum('k,ki,kj->ij', weights, away, away)
        expected = np.trace(moments) * np.eye(3) - moments
        assert np.abs(expected - tensor).max() < 0.01 * np.trace(tensor), name


def point_cloud(generator, parts, side=24):
    """Return points (k, 3) in the link's frame and their masses (k,), spread over the parts."""
    points, weights = [], []
    for part in parts:
        local = grid(part, side)
        points.append(local @ generator.rotation(part.rpy).T + np.array(part.xyz))
        weights.append(np.full(len(local), generator.part_mass(part) / len(local)))
    return np.vstack(points), np.concatenate(weights)


def grid(part, side):
    """Return points that fill a part evenly, shape (k, 3), in its own frame."""
    middle = (np.arange(side) + 0.5) / side
    a, b, c = (x.ravel() for x in np.meshgrid(middle, middle, middle))
    if part.shape == 'box':
        return (np.stack([a, b, c], axis=1) - 0.5) * part.size
    outer, inner, length = part.size
    radius = np.sqrt(inner**2 + a * (outer**2 - inner**2))  # even in area, not in radius
    angle = 2 * np.pi * b
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), (c - 0.5) * length], axis=1)


def test_it_can_hold_itself_anywhere(model):
    data, rng = model.createData(), np.random.default_rng(1)
    worst = np.zeros(model.nv)
    for _ in range(10_000):
        q = rng.uniform(model.lowerPositionLimit, model.upperPositionLimit)
        torque = pinocchio.computeGeneralizedGravity(model, data, q)
        worst = np.maximum(worst, np.abs(torque))
    assert np.all(worst < 0.7 * model.upperEffortLimit)
    assert worst[model.joints[model.getJointId('shoulder_pitch')].idx_v] > 30.0


def test_size_and_mass_are_those_of_a_research_arm(model):
    data = model.createData()
    pinocchio.framesForwardKinematics(model, data, pinocchio.neutral(model))
    shoulder, hand = (
        data.oMf[model.getFrameId(name)].translation for name in ('upper_arm', 'hand')
    )
    assert np.linalg.norm(hand - shoulder) == pytest.approx(0.85, abs=0.01)
    assert 18.0 < sum(inertia.mass for inertia in model.inertias) < 20.0


def test_it_exercises_a_reader_of_urdf(robot):
    assert any(origin.get('rpy') != '0 0 0' for origin in robot.findall('link/inertial/origin'))
    fixed = {
        joint.find('child').get('link')
        for joint in robot.findall('joint')
        if joint.get('type') == 'fixed'
    }
    parents = {joint.find('parent').get('link') for joint in robot.findall('joint')}
    assert fixed & parents and fixed - parents
    assert robot.find('joint/mimic').get('multiplier') == '1'
    assert robot.find('.//mesh') is None


def test_nothing_but_viscous_friction_slows_it_down(robot):
    dynamics = robot.findall('joint/dynamics')
    assert len(dynamics) == 9
    assert all(float(d.get('damping')) > 0 and float(d.get('friction')) == 0 for d in dynamics)
