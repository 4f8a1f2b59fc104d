"""
The kernels: arithmetic on raw arrays, compiled and unchecked, one line per formula.

`textbook` is the specification, slow and literal. `recursive` computes the same for every robot,
and `codegen` turns it into machine code for one. `packing` makes its arrays, `jit` compiles it,
`warm_up` does so in advance. `dynamics` checks shapes before it calls a kernel.

What may change here: the speed, never the numbers.

"""
