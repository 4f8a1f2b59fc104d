"""
A simulated arm held by the node for minutes or days, with injected faults: `python -m soak -h`.

Plain classes inject the faults and judge the node; rig and processes only carry messages.

"""
