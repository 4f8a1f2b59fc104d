"""
The results of the node beside the command: torques, matrices, external torque, diagnostics.

What may change here: topics that are published after the command.

"""
