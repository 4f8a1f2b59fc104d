"""
The executable `markers`: masses, inertia and torques for RViz, in a process of their own.

What may change here: how the markers program finds what it shows. What shapes look like is
decided in `visualization`, and nothing in here runs in the node that drives the arm.

"""
