"""
Machine code for one robot: the closed form without loops, zeros and questions.

A robot's tree is known before its state, so the formulas of `recursive` are run once on symbols
(`symbols`, `quantities`), written down as LLVM code for one state and for several states side by
side (`code`, `sine`, `functions`), given an entry from Python (`call`), compiled (`machine`), and
kept on disk (`store`). `robot_code` puts it together, `background` does so in another process.

A robot has two: its own knows the inertia of its bodies as it knows the tree; the other reads it
when it runs, and so serves every payload and every rotor inertia. It is a little slower.

Nobody has to wait for it: the general kernel answers until it is ready.

What may change here: how the formulas become machine code, never the formulas.

"""

from .compile import are_ordinary, from_disk, is_wanted, make, RobotCode
from .python_entry import is_supported, make_callable
from .worker import start

__all__ = [
    'RobotCode',
    'are_ordinary',
    'from_disk',
    'is_supported',
    'is_wanted',
    'make',
    'make_callable',
    'start',
]
