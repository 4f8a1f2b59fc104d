"""
The parameters of the node: one table, checked values, and the limits of a change while enabled.

A new parameter is one row of `table.PARAMETERS`; read it anywhere as `parameters['its_name']`.
Add it with its default to config/dynamics.yaml, and run scripts/write_reference.py.
If it is part of the model, `model_settings.configured` uses it.

What may change here: parameters, their checks and their descriptions.

"""
