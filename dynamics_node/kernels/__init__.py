"""
The kernels: raw numbers in, raw numbers out. Compiled, unchecked, one line per formula.

What may change here: how fast the same numbers come. `textbook` is the specification, slow
and literal; `closed_form` is what runs, compiled for every robot or `specialised` to one. Shapes
are checked in the room above (`dynamics`).

"""
