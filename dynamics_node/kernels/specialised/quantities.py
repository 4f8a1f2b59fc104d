"""
What is specialised: each quantity as a straight-line program, recorded from `closed_form`.

In the program of a robot, gravity is an input, and all other numbers are constants. With
`any_inertia`, the inertia of the bodies and of the rotors are inputs too: such a program is
longer, because none of them is known to be zero, but serves the robot under every load.

"""

from typing import Any, NamedTuple

import numpy as np

from .symbols import Program
from .. import closed_form

# Straight-line code grows with the square of the joints. Beyond this it takes long to compile
# and is read from memory more slowly than the general kernel's loops run.
MOST_OPERATIONS = 15_000


class Quantity(NamedTuple):
    """
    A function of the joint state as a straight-line program.

    Attributes
    ----------
    name : str
    joint_count : int
        n.
    inputs : tuple of str
        Names of its arguments, arrays of n numbers each.
    program : Program
        Its inputs are these and 'numbers': those of `packing.pack`, row after row.
    outputs : tuple of numpy.ndarray
        Symbols and floats.
    positive : tuple
        Symbols and floats that must be positive, otherwise the outputs mean nothing.

    """

    name: str
    joint_count: int
    inputs: tuple[str, ...]
    program: Program
    outputs: tuple[Any, ...]
    positive: tuple[Any, ...] = ()

    @property
    def operation_count(self):
        """How many operations the outputs need."""
        return len(self.program.needed(self.results()))

    def results(self):
        """Return everything to be computed, from the tips to the base, as the formulas go."""
        results = [
            (max(place), value)
            for output in self.outputs
            for place, value in np.ndenumerate(output)
        ]
        results.sort(key=lambda item: -item[0])
        return [*self.positive, *(value for _, value in results)]


def input_places(bodies, any_inertia):
    """
    Return which of a robot's numbers are inputs of its programs.

    Parameters
    ----------
    bodies : int
        N.
    any_inertia : bool
        Whether the inertia of bodies and rotors is among them.

    Returns
    -------
    list of tuple of int
        Row and column in the numbers of `packing.pack`.

    """
    places = [(bodies, column) for column in range(3)]
    if any_inertia:
        columns = [*range(closed_form.INERTIA, closed_form.MULTIPLIER), closed_form.ROTOR]
        places += [(row, column) for row in range(bodies) for column in columns]
    return places


class _Robot:
    # A robot in symbols: what the formulas of `closed_form` take.

    def __init__(self, structure, numbers, any_inertia):
        self.program = Program(MOST_OPERATIONS)
        self.structure = structure
        self.n = closed_form.joint_count(structure)
        self.numbers = numbers.astype(object)
        for row, column in input_places(len(structure), any_inertia):
            self.numbers[row, column] = self.program.input(
                'numbers', row * closed_form.WIDTH + column
            )
        self.work = tuple(array.astype(object) for array in closed_form.workspace(len(structure)))

    def inputs(self, name):
        return np.array([self.program.input(name, i) for i in range(self.n)], dtype=object)

    def zeros(self, *shape):
        return np.full(shape, 0.0, dtype=object)


def dynamics(structure, numbers, any_inertia=False):
    """Record D, C and G."""
    robot = _Robot(structure, numbers, any_inertia)
    D, C, G = robot.zeros(robot.n, robot.n), robot.zeros(robot.n, robot.n), robot.zeros(robot.n)
    closed_form.dynamics_of_state(
        structure, robot.numbers, robot.inputs('q'), robot.inputs('qd'), robot.work, D, C, G
    )
    return Quantity('dynamics', robot.n, ('q', 'qd'), robot.program, (D, C, G))


def mass_matrix(structure, numbers, any_inertia=False):
    """Record D."""
    robot = _Robot(structure, numbers, any_inertia)
    D = robot.zeros(robot.n, robot.n)
    closed_form.mass_matrix_of_state(structure, robot.numbers, robot.inputs('q'), robot.work, D)
    return Quantity('mass_matrix', robot.n, ('q',), robot.program, (D,))


def coriolis_matrix(structure, numbers, any_inertia=False):
    """Record C."""
    quantity = dynamics(structure, numbers, any_inertia)
    return quantity._replace(name='coriolis_matrix', outputs=quantity.outputs[1:2])


def gravity_torque(structure, numbers, any_inertia=False):
    """Record G."""
    robot = _Robot(structure, numbers, any_inertia)
    G = robot.zeros(robot.n)
    closed_form.gravity_of_state(structure, robot.numbers, robot.inputs('q'), robot.work, G)
    return Quantity('gravity_torque', robot.n, ('q',), robot.program, (G,))


def inverse_dynamics(structure, numbers, any_inertia=False):
    """Record the efforts of a motion."""
    robot = _Robot(structure, numbers, any_inertia)
    tau = robot.zeros(robot.n)
    closed_form.inverse_dynamics_of_state(
        structure,
        robot.numbers,
        robot.inputs('q'),
        robot.inputs('qd'),
        robot.inputs('qdd'),
        robot.work,
        tau,
    )
    return Quantity('inverse_dynamics', robot.n, ('q', 'qd', 'qdd'), robot.program, (tau,))


def forward_dynamics(structure, numbers, any_inertia=False):
    """Record the accelerations that efforts cause, D q̈ = τ - (C q̇ + G)."""
    robot = _Robot(structure, numbers, any_inertia)
    q, qd, tau = robot.inputs('q'), robot.inputs('qd'), robot.inputs('tau')
    D, qdd = robot.zeros(robot.n, robot.n), robot.zeros(robot.n)
    pivots, margins = robot.zeros(robot.n), robot.zeros(robot.n)
    try:
        closed_form.forward_dynamics_of_state(
            structure,
            robot.numbers,
            q,
            qd,
            tau,
            robot.zeros(robot.n),
            robot.work,
            D,
            pivots,
            margins,
            qdd,
        )
    except ZeroDivisionError:
        # A pivot is zero whatever the state: `positive` says that the result means nothing.
        qdd, margins = robot.zeros(robot.n), robot.zeros(1)
    return Quantity(
        'forward_dynamics', robot.n, ('q', 'qd', 'tau'), robot.program, (qdd,), tuple(margins)
    )


ALL = (gravity_torque, dynamics, inverse_dynamics, mass_matrix, forward_dynamics, coriolis_matrix)

# Names of the arguments, and how many outputs.
SIGNATURES = {
    'gravity_torque': (('q',), 1),
    'dynamics': (('q', 'qd'), 3),
    'inverse_dynamics': (('q', 'qd', 'qdd'), 1),
    'mass_matrix': (('q',), 1),
    'forward_dynamics': (('q', 'qd', 'tau'), 1),
    'coriolis_matrix': (('q', 'qd'), 1),
}
