"""frax: its methods under one jax.jit, in double precision, as its README recommends."""

import os
from pathlib import Path
import tempfile

# Before the first import of jax: what frax's README asks for on a CPU.
os.environ.setdefault('JAX_ENABLE_X64', '1')
os.environ.setdefault('JAX_PLATFORMS', 'cpu')
os.environ.setdefault('OPENBLAS_NUM_THREADS', '1')
os.environ.setdefault('XLA_FLAGS', '--xla_cpu_multi_thread_eigen=false')

import frax
import jax

from ..quantities import Call

NAME = 'frax'
PACKAGE = 'frax'
NOTE = (
    'It has no C: beside D it gives the vectors C q̇ and G, one compiled function for all '
    'three. Double precision, one thread, the JAX that its README names as the fastest on '
    'a CPU. Compiling is not counted, waiting for the result is. It has no inverse dynamics '
    'of its own; D q̈ + bias is compiled instead.'
)


def robot_of(robot):
    """
    Return frax's robot.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    frax.Robot

    """
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / 'robot.urdf'
        path.write_text(robot.text)
        return frax.Robot(str(path), joint_ordering=list(robot.model.joint_names))


def calls(robot):
    """
    Return frax's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    arm = robot_of(robot)
    all_terms = jax.jit(terms(arm))
    only_D = jax.jit(lambda q: (arm.mass_matrix(q),))
    only_G = jax.jit(lambda q: (arm.gravity_vector(q),))
    tau = jax.jit(lambda q, qd, qdd: (arm.mass_matrix(q) @ qdd + arm.nonlinear_bias(q, qd),))
    qdd = jax.jit(lambda q, qd, tau: (arm.forward_dynamics(q, qd, tau, None),))
    wait = jax.block_until_ready
    return {
        'dynamics': Call(
            lambda q, qd: wait(all_terms(q, qd)),
            ('D', 'C qd', 'G'),
            'mass_matrix, centrifugal_coriolis_vector, gravity_vector',
        ),
        'mass_matrix': Call(lambda q: wait(only_D(q)), ('D',), 'mass_matrix'),
        'gravity': Call(lambda q: wait(only_G(q)), ('G',), 'gravity_vector'),
        'inverse': Call(
            lambda q, qd, qdd: wait(tau(q, qd, qdd)), ('tau',), 'mass_matrix @ q̈ + nonlinear_bias'
        ),
        'forward': Call(lambda q, qd, tau: wait(qdd(q, qd, tau)), ('qdd',), 'forward_dynamics'),
    }


def batch(robot):
    """
    Return a function of many states: D, C q̇ and G by one compiled vmap.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    callable
        Takes Q and QD, shape (N, n); returns arrays (N, n, n), (N, n), (N, n).

    """
    many = jax.jit(jax.vmap(terms(robot_of(robot))))
    return lambda Q, QD: jax.block_until_ready(many(Q, QD))


def terms(arm):
    """
    Return the function of one state that gives D, C q̇ and G.

    Parameters
    ----------
    arm : frax.Robot

    Returns
    -------
    callable

    """

    def function(q, qd):
        return (arm.mass_matrix(q), arm.centrifugal_coriolis_vector(q, qd), arm.gravity_vector(q))

    return function
