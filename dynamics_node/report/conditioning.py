"""Condition number of the mass matrix over the workspace."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .report import ConditioningEntry
from .workspace_analysis import prismatic_joints, WorkspaceAnalysis
from ..dynamics import RobotModel
from ..errors import SingularMassMatrixError

# Bounds of the number of positions.
_MAX_SAMPLES, _MIN_SAMPLES = 1000, 100
# Number of positions times n³: eigenvalues take cubic time.
_WORK = 50_000_000


def conditioning_entry(analysis: WorkspaceAnalysis) -> ConditioningEntry:
    """
    Return the condition number of D over the samples.

    Parameters
    ----------
    analysis : WorkspaceAnalysis
        Of a robot with at least one joint.

    Returns
    -------
    ConditioningEntry

    """
    model, n = analysis.model, len(analysis.model.joint_names)
    count = min(_MAX_SAMPLES, max(_MIN_SAMPLES, _WORK // n**3), len(analysis.positions))
    numbers, is_definite = np.empty(count), True
    for rows in analysis.batches(n * n, count):
        values = np.linalg.eigvalsh(np.nan_to_num(model.mass_matrix(analysis.positions[rows])))
        positive = values[:, 0] > 0.0
        numbers[rows] = np.where(
            positive, values[:, -1] / np.where(positive, values[:, 0], 1.0), np.inf
        )
        is_definite = is_definite and _is_invertible(model, analysis.positions[rows])
    worst = analysis.positions[int(np.argmax(numbers))]
    vector = np.linalg.eigh(np.nan_to_num(model.mass_matrix(worst)))[1][:, 0]
    return ConditioningEntry(
        median=float(np.median(numbers)),
        worst=float(np.max(numbers)),
        position=tuple(worst.tolist()),
        weakest_joint=model.joint_names[int(np.argmax(np.abs(vector)))],
        is_positive_definite=is_definite,
        has_mixed_units=0 < sum(prismatic_joints(model)) < n,
        samples=count,
    )


def _is_invertible(model: RobotModel, positions: NDArray[np.float64]) -> bool:
    # The same criterion as in the library and the node.
    zeros = np.zeros_like(positions)
    try:
        model.forward_dynamics(positions, zeros, zeros)
    except SingularMassMatrixError:
        return False
    return True
