"""
From a joint state to the command of the controller, and every check that can stop it.

What may change here: how messages become calls of `safety.TorquePath` and commands become
messages. What is sent is decided in `safety`.

"""
