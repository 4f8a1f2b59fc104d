"""
A simulated robot in a process of its own, and the demo that lets it fall and holds it.

What may change here: the simulation, the story and the picture. Nothing in here imports the
library: the simulation is the judge of its numbers.

"""
