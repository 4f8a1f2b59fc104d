"""
The effort guard's process: between the dynamics node and the effort controller.

What may change here: topics, parameters, messages. `safety.effort_guard` decides which commands
pass and which fade. Nothing here may import the dynamics of the library, numba or yourdfpy: the
guard has to start at once, stay small, and run independently of the node.

"""
