"""
The effort guard: a process between the dynamics node and the effort controller.

What may change here: topics, parameters, log and diagnostics. Passing and fading are decided in
`safety.effort_guard`. Nothing here may import the library's dynamics, numba or yourdfpy: the
guard must start at once, stay small and run when the node does not.

"""
