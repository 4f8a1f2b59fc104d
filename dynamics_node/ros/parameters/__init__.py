"""
The parameters of the node: one table, checked values, and what a change may do to a held arm.

What may change here: parameters, their checks and descriptions. A new one is a row of `table`.

"""
