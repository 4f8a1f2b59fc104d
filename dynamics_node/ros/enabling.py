"""The service ~/enable: everything that has to be in order before the arm is driven."""

import time

from std_srvs.srv import SetBool

from .controller_check import ControllerCheck
from .late_answers import LateAnswers


class Enabling:
    """
    Switches the output on, if nothing speaks against it, and off.

    Attributes
    ----------
    was_asked : bool
        Whether anybody has called ~/enable, with true or false.

    """

    def __init__(self, node, parameters, get_robot, output, rivals):
        """
        Create the service.

        Parameters
        ----------
        node : rclpy.node.Node
        parameters : Parameters
        get_robot : callable() -> Robot or None
        output : CommandOutput
        rivals : Rivals

        """
        self.logger = node.get_logger()
        self.was_asked = False
        self._parameters = parameters
        self._get_robot = get_robot
        self._output = output
        self._rivals = rivals
        self._controllers = ControllerCheck(node, output.topic)
        self._waiting = []
        self._asked_for = ()
        self._service = LateAnswers(node, SetBool, '~/enable', self._requested)

    def enable(self, answer):
        """
        Switch the output on if nothing speaks against it.

        Parameters
        ----------
        answer : callable(bool, str)
            Called once, now or when the controllers have answered: accepted, and the reasons
            why not or what to know.

        """
        machine = self._output.channel.machine
        if machine.is_driving:
            answer(True, f'already enabled: {machine.name}')
        elif machine.is_on:
            answer(False, 'still stopping: ask again when the state is READY')
        elif reasons := self.refusals():
            answer(False, _refused(reasons))
        else:
            self._waiting.append(answer)
            if not self._controllers.is_busy:
                self._asked_for = self._get_robot().joint_names
                self._controllers.begin(self._asked_for, self._checked)

    def disable(self, answer):
        """Switch the output off; `answer` as for `enable`."""
        machine = self._output.channel.machine
        self._answer_all(False, 'disabled on request before it was enabled')
        if machine.is_driving:
            self._output.stop('disabled on request')
            answer(True, 'stopping')
        else:
            answer(True, f'already off: {machine.name}')

    def refusals(self):
        """Return every reason why the output must not be enabled now, as a list of str."""
        robot = self._get_robot()
        if robot is None:
            return ['no robot description yet']
        reasons = []
        timeout = self._parameters['state_timeout']
        stale = robot.buffer.stale_joints(time.monotonic(), timeout)
        if stale:
            dropped = ', '.join(f'{count} for {kind}' for kind, count in
                                robot.buffer.rejected.most_common())
            reasons.append(f'no joint state within {timeout:g} s for {", ".join(stale)}'
                           + (f' (dropped so far: {dropped})' if dropped else ''))
        elif not robot.is_mass_matrix_positive_definite():
            reasons.append('the mass matrix is not positive definite: check the <inertial> of '
                           'the moving links')
        unlimited = robot.unlimited_joints(self._parameters['effort_limits'])
        if unlimited:
            reasons.append(f'no effort limit for {", ".join(unlimited)}: set the parameter '
                           'effort_limits')
        return reasons + self._rivals.found()

    def _requested(self, request, answer):
        self.was_asked = True
        (self.enable if request.data else self.disable)(answer.give)

    def _checked(self, refusals, notes):
        # All of it anew: time has passed.
        reasons = self.refusals() + self._other_joints() + refusals if self._waiting else []
        if reasons:
            self._answer_all(False, _refused(reasons))
        elif self._waiting:
            self._answer_all(True, self._output.begin(notes + self._unseen()))

    def _other_joints(self):
        # What the controllers have said was compared with the joints of that time.
        robot = self._get_robot()
        if robot is None or robot.joint_names == self._asked_for:
            return []
        return ['the robot description has changed its joints while the controllers were asked: '
                'ask again']

    def _unseen(self):
        names = self._get_robot().joints_without_velocity_limit()
        return [f'jumps and runaway are not noticed of {", ".join(names)}: the URDF has no '
                'velocity limit there'] if names else []

    def _answer_all(self, success, message):
        waiting, self._waiting = self._waiting, []
        for answer in waiting:
            answer(success, message)


def _refused(reasons):
    return 'refused: ' + '; '.join(reasons)
