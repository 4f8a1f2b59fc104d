"""When two computations of D, C and G agree: element by element, up to rounding."""

import numpy as np

# Where a sum cancels, an element can be arbitrarily smaller than its summands, and then its
# relative error says nothing; such an element is held to this part of the natural scale of
# its place instead (see `natural_scales`).
ROUNDING = 1e-12


def natural_scales(model, D, qd):
    """
    Return what the elements of D, C and G are summed from, by Cauchy and Schwarz.

    |D_ij| <= sqrt(D_ii D_jj), and |G_i| <= |g| sqrt(m D_ii) with the moving mass m; C is of
    the size of D times a speed.

    """
    diagonal = np.sqrt(np.maximum(np.diag(D), 0.0))
    scale = np.outer(diagonal, diagonal)
    return (scale, scale * np.abs(qd).max(initial=0.0),
            np.linalg.norm(model.gravity) * np.sqrt(model.total_mass) * diagonal)


def assert_terms_agree(model, qd, actual, expected, relative):
    """Hold every element of D, C and G to `relative` of itself, or to rounding of its scale."""
    scales = natural_scales(model, expected[0], qd)
    for name, mine, theirs, scale in zip('DCG', actual, expected, scales, strict=True):
        error = np.abs(mine - theirs)
        allowed = np.maximum(relative * np.abs(theirs), ROUNDING * scale)
        worst = np.unravel_index(np.argmax(error - allowed), error.shape)
        assert (error <= allowed).all(), (
            f'{name}{list(map(int, worst))}: {mine[worst]!r}, expected {theirs[worst]!r}, '
            f'scale {scale[worst]!r}')
