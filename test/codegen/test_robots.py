"""Accuracy of machine code, both of a robot and of its payload variant."""

from dynamics_node import RobotModel
import numpy as np
import pytest
from support.extreme_robots import extreme_robots
from support.machine_code import needs_machine_code
from support.random_payload import random_body, with_payload_link
from support.result_cache import BOUND, row
from support.robots import public_robot

pytestmark = needs_machine_code

# Compiling takes one or two seconds per robot. The general kernel is tested like this on all
# robots; test_trace and test_manager compare machine code with it on random trees.
PUBLIC = (
    'ur_description/urdf/ur5_robot.urdf',
    'panda_description/urdf/panda.urdf',
    'kinova_description/robots/kinova.urdf',
)
EXTREME = [name for name in extreme_robots() if 'boom' in name or 'km away' in name]


# A mimic joint, fingers, and the two worst cases of rounding.
CARRIERS = {
    'panda': (lambda: public_robot(PUBLIC[1]).read_text(), 'panda_leftfinger'),
    'kinova': (lambda: public_robot(PUBLIC[2]).read_text(), 'j2s6s200_link_finger_1'),
    'far away': (lambda: extreme_robots()['arm7, its base 1000 km away'], 'hand'),
    'boom': (lambda: extreme_robots()['1e-6 kg at the end of a turning boom of 10 km'], 'link2'),
}


def specialized(source):
    model = RobotModel.from_urdf(source)
    assert model.specialize()
    return model


@pytest.mark.parametrize('name', PUBLIC)
def test_a_public_robot_is_within_the_accuracy_bound(name):
    text = public_robot(name).read_text()
    errors = row(name, text, specialized(text)).errors
    for judge in ('pinocchio', 'exact'):
        for quantity, error in errors['library', judge].items():
            assert error <= BOUND, (judge, quantity)


@pytest.mark.parametrize('name', EXTREME)
def test_an_extreme_robot_keeps_its_digits(name):
    text = extreme_robots()[name]
    errors = row(name, text, specialized(text)).errors['library', 'exact']
    for quantity in ('D', 'C', 'G', 'ID', 'energy'):
        assert errors[quantity] <= BOUND, quantity


@pytest.mark.parametrize('name', CARRIERS)
def test_payload_code_is_within_the_accuracy_bound(name):
    text, link = CARRIERS[name][0](), CARRIERS[name][1]
    rng = np.random.default_rng(3)
    model = RobotModel.from_urdf(text)
    assert model.with_payload(link, 1.0).specialize()
    for _ in range(2):
        body = random_body(rng)
        loaded = model.with_payload(link, *body)
        assert loaded.is_specialized
        errors = row(name, with_payload_link(text, link, *body), loaded).errors
        for judge in ('exact',) if name in ('far away', 'boom') else ('pinocchio', 'exact'):
            for quantity, error in errors['library', judge].items():
                assert error <= BOUND, (judge, quantity)


def test_payload_code_on_massless_links_is_within_the_accuracy_bound():
    # The last three links are empty frames that joints turn.
    frames = (('tool0', 'e0', '1 0 0'), ('e0', 'e1', '0 1 0'), ('e1', 'e2', '0 0 1'))
    empty = ''.join(
        f"""<link name="{link}"/><joint name="turns_{link}" type="continuous">
        <parent link="{parent}"/><child link="{link}"/><origin xyz="0 0.1 0.05"/>
        <axis xyz="{axis}"/></joint>"""
        for parent, link, axis in frames
    )
    text = public_robot(PUBLIC[0]).read_text()
    text = text[: text.rindex('</robot>')] + empty + '</robot>'
    model = RobotModel.from_urdf(text)
    assert (model.tree.inertia[-3:] == 0.0).all()
    for link in ('e2', 'e1'):
        body = random_body(np.random.default_rng(4))
        loaded = model.with_payload(link, *body)
        assert loaded.specialize()
        errors = row(link, with_payload_link(text, link, *body), loaded).errors
        for judge in ('pinocchio', 'exact'):
            for quantity, error in errors['library', judge].items():
                assert error <= BOUND, (judge, quantity)
