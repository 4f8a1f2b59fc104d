"""How well the mass matrix can be inverted."""

import numpy as np

from .report import ConditioningEntry
from ..errors import SingularMassMatrixError
from ..model.tree import PRISMATIC

# Eigenvalues take time, which grows with the third power of the joints: fewer positions for more.
_MOST_SAMPLES, _LEAST_SAMPLES, _WORK = 1000, 100, 50_000_000


def conditioning_entry(study):
    """
    Return the condition number of D over the samples.

    Parameters
    ----------
    study : Study
        Of a robot with at least one joint.

    Returns
    -------
    ConditioningEntry

    """
    model, n = study.model, len(study.model.joint_names)
    count = min(_MOST_SAMPLES, max(_LEAST_SAMPLES, _WORK // n**3), len(study.positions))
    numbers, is_definite = np.empty(count), True
    for rows in study.batches(n * n, count):
        values = np.linalg.eigvalsh(np.nan_to_num(model.mass_matrix(study.positions[rows])))
        positive = values[:, 0] > 0.0
        numbers[rows] = np.where(
            positive, values[:, -1] / np.where(positive, values[:, 0], 1.0), np.inf
        )
        is_definite = is_definite and _has_answer(model, study.positions[rows])
    worst = study.positions[int(np.argmax(numbers))]
    vector = np.linalg.eigh(np.nan_to_num(model.mass_matrix(worst)))[1][:, 0]
    slides = {
        int(model.tree.q_index[body])
        for body in np.flatnonzero(
            (model.tree.joint_type == PRISMATIC) & model.tree.is_independent
        )
    }
    return ConditioningEntry(
        median=float(np.median(numbers)),
        worst=float(np.max(numbers)),
        position=tuple(worst.tolist()),
        weakest_joint=model.joint_names[int(np.argmax(np.abs(vector)))],
        is_positive_definite=is_definite,
        has_mixed_units=0 < len(slides) < n,
        samples=count,
    )


def _has_answer(model, positions):
    # Where the library and the node draw the line.
    rest = np.zeros_like(positions)
    try:
        model.forward_dynamics(positions, rest, rest)
    except SingularMassMatrixError:
        return False
    return True
