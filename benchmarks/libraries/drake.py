"""Drake: a continuous MultibodyPlant and one context; a new state empties its caches."""

from pydrake.multibody.parsing import Parser
from pydrake.multibody.plant import MultibodyPlant
from pydrake.multibody.tree import MultibodyForces

from ..quantities import Call

NAME = 'Drake'
PACKAGE = 'drake'
NOTE = (
    'It has no C: beside D it gives the vectors C q̇ and G. Setting the state in the context '
    "is included; quantities of one state share the context's cache."
)


def plant_of(robot):
    """
    Return Drake's plant of a robot, its root fixed to the world.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    MultibodyPlant

    Raises
    ------
    ValueError
        If its order of joints differs.

    """
    plant = MultibodyPlant(0.0)
    Parser(plant).AddModelsFromString(robot.text, 'urdf')
    # Drake identifies a link of this name with its world.
    if robot.model.tree.root != 'world':
        plant.WeldFrames(plant.world_frame(), plant.GetFrameByName(robot.model.tree.root))
    plant.Finalize()
    joints = [plant.get_joint(index) for index in plant.GetJointIndices()]
    moving = sorted(
        (joint for joint in joints if joint.num_velocities()),
        key=lambda joint: joint.velocity_start(),
    )
    names = tuple(joint.name() for joint in moving)
    robot.check_joint_order(names)
    return plant


def calls(robot):
    """
    Return Drake's calls.

    Parameters
    ----------
    robot : Robot

    Returns
    -------
    dict of str to Call

    """
    plant = plant_of(robot)
    context = plant.CreateDefaultContext()
    forces = MultibodyForces(plant)
    applied = plant.get_applied_generalized_force_input_port()
    torque = applied.FixValue(context, robot.states[0][2])

    def dynamics(q, qd):
        plant.SetPositions(context, q)
        plant.SetVelocities(context, qd)
        return (
            plant.CalcMassMatrix(context),
            plant.CalcBiasTerm(context),
            -plant.CalcGravityGeneralizedForces(context),
        )

    def mass_matrix(q):
        plant.SetPositions(context, q)
        return (plant.CalcMassMatrix(context),)

    def gravity(q):
        plant.SetPositions(context, q)
        return (-plant.CalcGravityGeneralizedForces(context),)

    def inverse(q, qd, qdd):
        plant.SetPositions(context, q)
        plant.SetVelocities(context, qd)
        plant.CalcForceElementsContribution(context, forces)
        return (plant.CalcInverseDynamics(context, qdd, forces),)

    def forward(q, qd, tau):
        plant.SetPositions(context, q)
        plant.SetVelocities(context, qd)
        torque.GetMutableData().set_value(tau)
        derivatives = plant.EvalTimeDerivatives(context)
        return (derivatives.get_generalized_velocity().CopyToVector(),)

    return {
        'dynamics': Call(
            dynamics,
            ('D', 'C qd', 'G'),
            'CalcMassMatrix, CalcBiasTerm, CalcGravityGeneralizedForces',
        ),
        'mass_matrix': Call(mass_matrix, ('D',), 'CalcMassMatrix'),
        'gravity': Call(gravity, ('G',), 'CalcGravityGeneralizedForces'),
        'inverse': Call(inverse, ('tau',), 'CalcForceElementsContribution, CalcInverseDynamics'),
        'forward': Call(forward, ('qdd',), 'EvalTimeDerivatives'),
    }
