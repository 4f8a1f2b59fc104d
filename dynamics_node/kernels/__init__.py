"""
The kernels: raw numbers in, raw numbers out. Compiled, unchecked, one line per formula.

What may change here: how fast the same numbers come. `textbook` is the specification, slow and
literal; `recursive` is what runs for every robot, and what `codegen` turns into machine code for
one. Shapes are checked in the room above (`dynamics`).

"""
