"""Comparison of D, C, G and accelerations, element by element, up to rounding."""

from typing import NamedTuple

import numpy as np

# Tolerance relative to the natural scale (see `natural_scales`), for elements much smaller than
# their summands: their relative error is meaningless.
ROUNDING = 1e-12


def natural_scales(model, D, qd):
    """
    Return bounds of the summands of the elements of D, C and G, by Cauchy and Schwarz.

    |D_ij| <= sqrt(D_ii D_jj), and |G_i| <= |g| sqrt(m D_ii) with the moving mass m; C is of
    the size of D times a speed.

    """
    diagonal = np.sqrt(np.maximum(np.diag(D), 0.0))
    scale = np.outer(diagonal, diagonal)
    return (
        scale,
        scale * np.abs(qd).max(initial=0.0),
        np.linalg.norm(model.gravity) * np.sqrt(model.moving_mass) * diagonal,
    )


def assert_terms_agree(model, qd, actual, expected, relative):
    """Assert D, C and G up to `relative` of each element, or up to rounding of its scale."""
    scales = natural_scales(model, expected[0], qd)
    for name, mine, theirs, scale in zip('DCG', actual, expected, scales, strict=True):
        error = np.abs(mine - theirs)
        allowed = np.maximum(relative * np.abs(theirs), ROUNDING * scale)
        worst = np.unravel_index(np.argmax(error - allowed), error.shape)
        assert (error <= allowed).all(), (
            f'{name}{list(map(int, worst))}: {mine[worst]!r}, expected {theirs[worst]!r}, '
            f'scale {scale[worst]!r}'
        )


# Errors are relative to the element, or to this share of its natural scale if that is larger.
CANCELLED = 0.1


class Scales(NamedTuple):
    """The natural scales of all compared elements."""

    D: np.ndarray
    C: np.ndarray
    G: np.ndarray
    ID: np.ndarray
    FD: np.ndarray | None


def all_scales(model, D, qd, qdd):
    """
    Return the scales of D, C, G, of inverse and of forward dynamics.

    Efforts are the sums of D q̈, C q̇ and G. An acceleration is bounded, by Cauchy and Schwarz
    in the norm that D makes, |q̈_i|² <= (D⁻¹)_ii q̈ᵀ D q̈. FD is None for a singular D: the
    acceleration is then undefined.

    """
    sizes = natural_scales(model, D, qd)
    efforts = sizes[0] @ np.abs(qdd) + sizes[1] @ np.abs(qd) + sizes[2]
    try:
        inverse = np.linalg.inv(np.linalg.cholesky(D))
    except np.linalg.LinAlgError:
        return Scales(*sizes, efforts, None)
    diagonal = np.square(inverse).sum(axis=0)
    return Scales(*sizes, efforts, np.sqrt(diagonal * (qdd @ D @ qdd)))


def relative_error(actual, expected, scale):
    """
    Return the largest relative error of the elements of an array.

    Each error is divided by the element or by CANCELLED times its scale, whichever is larger.
    Equal elements have no error, even if both are zero; NaN stays NaN.

    """
    expected = np.asarray(expected)
    error = np.abs(np.asarray(actual) - expected)
    size = np.maximum(np.abs(expected), CANCELLED * np.asarray(scale))
    with np.errstate(divide='ignore', invalid='ignore'):
        relative = np.where(error == 0, 0.0, error / size)
    return float(np.max(relative, initial=0.0))


def condition(D):
    """
    Return the condition number of D with its diagonal scaled to 1.

    The scaling removes units and sizes of the joints, which do not affect a Cholesky solution.
    Infinite for a singular D.

    """
    diagonal = np.diag(D)
    if not (diagonal > 0).all():
        return np.inf
    eigenvalues = np.linalg.eigvalsh(D / np.sqrt(np.outer(diagonal, diagonal)))
    return float(eigenvalues[-1] / eigenvalues[0]) if eigenvalues[0] > 0 else np.inf
