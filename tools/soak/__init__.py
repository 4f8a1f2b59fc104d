"""
A simulated arm held by the node for as long as one likes, while faults are put on its line.

`python -m soak -h`. The plain classes here decide what is wrong on the line and whether the node
took it well; the processes and the rig only carry messages to them.

"""
