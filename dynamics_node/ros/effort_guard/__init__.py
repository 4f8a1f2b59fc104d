"""
The effort guard's process: between the dynamics node and the effort controller.

What may change here: topics, parameters, what is told. What passes and what fades is decided in
`safety.effort_guard`. Nothing here may import the library's dynamics, numba or yourdfpy: the
guard has to start at once, stay small and run when the node does not.

"""
