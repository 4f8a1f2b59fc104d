"""One state of one robot by the library, Pinocchio, MuJoCo and 80-bit arithmetic."""

from typing import NamedTuple

from dynamics_node import SingularMassMatrixError
import numpy as np

from .comparison import all_scales, CANCELLED, condition, relative_error
from .extended_precision import ExtendedPrecision, solve
from .mujoco_oracle import MujocoOracle
from .pinocchio_oracle import PinocchioOracle
from .robots import random_state

QUANTITIES = ('D', 'C', 'G', 'ID', 'FD', 'energy')


class Answer(NamedTuple):
    """The results of one route for one state; FD is None for a singular D."""

    D: np.ndarray
    C: np.ndarray
    G: np.ndarray
    ID: np.ndarray
    FD: np.ndarray | None
    kinetic: float
    potential: float


class Comparison(NamedTuple):
    """
    The errors at one state.

    `errors` maps a pair of routes to the relative errors by quantity: ('library', 'pinocchio'),
    ('library', 'mujoco'), and each of the three with 'exact', the 80-bit arithmetic. `plain`
    maps each of the three to the error of its accelerations, the largest error divided by the
    largest acceleration. `condition` is that of D.

    """

    errors: dict
    plain: dict
    condition: float


class Routes:
    """A robot and its three references, each with its own reader of the URDF."""

    def __init__(self, text, model):
        """Read URDF text by all references; `model` is the library's."""
        self.model = model
        self.exact = ExtendedPrecision(text)
        self.judges = {'pinocchio': PinocchioOracle(text), 'mujoco': MujocoOracle(text)}

    def compare(self, rng):
        """Compare all routes at one random state; return a Comparison."""
        q, qd = random_state(rng, self.model)
        qdd = rng.normal(0.0, 3.0, q.size)
        names = self.model.joint_names
        terms = self.exact.dynamics(names, q, qd)
        efforts = terms.D @ qdd + terms.C @ qd + terms.G
        tau = efforts.astype(float)
        D = terms.D.astype(float)
        scales = all_scales(self.model, D, qd, qdd)
        answers = {'library': _ask_library(self.model, q, qd, qdd, tau)}
        for name, judge in self.judges.items():
            answers[name] = Answer(
                *judge.dynamics(names, q, qd),
                judge.inverse_dynamics(names, q, qd, qdd),
                None if scales.FD is None else judge.forward_dynamics(names, q, qd, tau),
                *judge.energies(names, q, qd),
            )
        exact = Answer(
            terms.D,
            terms.C,
            terms.G,
            efforts,
            None if scales.FD is None else solve(terms.D, tau - terms.C @ qd - terms.G),
            terms.kinetic,
            terms.potential,
        )
        pairs = [('library', name) for name in self.judges] + [(name, 'exact') for name in answers]
        plain = (
            {}
            if scales.FD is None
            else {
                name: relative_error(answer.FD, exact.FD, np.abs(exact.FD).max() / CANCELLED)
                for name, answer in answers.items()
            }
        )
        answers['exact'] = exact
        return Comparison(
            {(a, b): _errors(answers[a], answers[b], scales, terms.height) for a, b in pairs},
            plain,
            condition(D),
        )


def worst_of(dicts):
    """Return the largest value of each key; a value that is not finite counts as the worst."""
    result: dict = {}
    for one in dicts:
        for key, value in one.items():
            # max() would drop a NaN that comes second.
            result[key] = np.fmax(result.get(key, 0.0), np.inf if np.isnan(value) else value)
    return {key: float(value) for key, value in result.items()}


def _ask_library(model, q, qd, qdd, tau):
    try:
        accelerations = model.forward_dynamics(q, qd, tau)
    except SingularMassMatrixError:
        accelerations = None
    return Answer(
        *model.dynamics(q, qd),
        model.inverse_dynamics(q, qd, qdd),
        accelerations,
        model.kinetic_energy(q, qd),
        model.potential_energy(q),
    )


def _errors(actual, expected, scales, height):
    errors = {
        name: relative_error(getattr(actual, name), getattr(expected, name), getattr(scales, name))
        for name in ('D', 'C', 'G', 'ID')
    }
    if scales.FD is not None:
        # The library has to answer unless D is singular.
        mine = np.nan if actual.FD is None else actual.FD
        errors['FD'] = relative_error(mine, expected.FD, scales.FD)
    errors['energy'] = max(
        relative_error(actual.kinetic, expected.kinetic, 0.0),
        relative_error(actual.potential, expected.potential, height),
    )
    return errors
