"""
Inertia: 4x4 pseudo-inertia matrices of rigid bodies, without robots and joints.

What may change here: construction, conversion, combination and checks of a body's J. The
conventions (frames, signs) are fixed, because every other room depends on them.

"""

from .consistency import check_physical, consistency_report, ConsistencyReport
from .equivalent_box import equivalent_box, EquivalentBox
from .integration import pseudo_inertia_by_integration
from .pseudo_inertia import (
    axial_moments,
    combine,
    inertia_tensor_at_com,
    mass_and_com,
    planar_moments,
    pseudo_inertia,
    steiner,
    transform_pseudo_inertia,
)
from .solids import box, cylinder, sphere

__all__ = [
    'ConsistencyReport',
    'EquivalentBox',
    'axial_moments',
    'box',
    'check_physical',
    'combine',
    'consistency_report',
    'cylinder',
    'equivalent_box',
    'inertia_tensor_at_com',
    'mass_and_com',
    'planar_moments',
    'pseudo_inertia',
    'pseudo_inertia_by_integration',
    'sphere',
    'steiner',
    'transform_pseudo_inertia',
]
