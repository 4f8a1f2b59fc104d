"""
The model: a checked description becomes the tree of moving bodies that the kernels walk.

What may change here: how fixed links are lumped, how joints are ordered, how mimic joints are
resolved. The model is frozen; changing it means making a new one.

"""

from .build import build_tree
from .tree import KinematicTree, LinkFrame

__all__ = ['KinematicTree', 'LinkFrame', 'build_tree']
