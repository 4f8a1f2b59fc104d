"""
The executable `markers`: masses, inertia and torques for RViz, in a separate process.

Shapes are defined in `visualization`. No module here runs in the node that drives the arm.

"""
