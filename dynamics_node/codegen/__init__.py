"""
Machine code for one robot: the recursion unrolled, zeros folded, branch-free.

A robot's tree is known before its state. So the formulas of `kernels.recursive` are run once on
tracing scalars (`trace`), written as LLVM code for one state and for several states side by side
(`llvm_ir`, `sine`), given an entry from Python (`python_entry`), compiled for this processor
(`llvm_target`), compared with the general kernel (`compile`) and kept on disk (`disk_cache`).
`manager` decides when, and `worker` does it in another process; until then the general kernel
answers.

A robot has two codes: its own contains the inertia of its bodies; the payload variant reads it
when it runs, and so serves every payload and every rotor inertia. It is a little slower.

What may change here: how the formulas become machine code, never the formulas.

"""

from .compile import RobotCode
from .manager import Specialization
from .python_entry import is_supported

__all__ = ['RobotCode', 'Specialization', 'is_supported']
