"""
The simulated robot, a separate process, and the demo: a fall without the node, rest with it.

What may change here: the simulation, the sequence and the picture. The simulation judges the
numbers of the library, so no module here imports the library.

"""
