"""
The torque path: from a joint state to a command, and the checks that can stop it.

What may change here: the conversion between messages and calls of `safety.TorquePath`. The
commands themselves are decided in `safety`.

"""
