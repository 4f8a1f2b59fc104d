"""
The results of the node besides the command: torques, matrices, external torque, diagnostics.

What may change here: what is published after the command has gone out.

"""
