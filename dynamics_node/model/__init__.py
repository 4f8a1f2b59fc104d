"""
The model: from a checked description to the tree of moving bodies that the kernels use.

What may change here: the lumping of fixed links, the order of joints, the resolution of mimic
joints. A model is frozen; a changed robot is a new model.

"""

from .build import build_tree
from .tree import KinematicTree, LinkFrame

__all__ = ['KinematicTree', 'LinkFrame', 'build_tree']
