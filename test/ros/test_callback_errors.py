"""No exception leaves a callback."""

from dynamics_node.ros.support.callback_errors import guarded, guarded_service, logged
from std_srvs.srv import SetBool


class Broken:
    """Callbacks that fail, with their log and the reported internal errors."""

    def __init__(self):
        self.logger = self
        self.logged, self.reported = [], []
        self.error = self.logged.append
        self.on_internal_error = self.reported.append

    @guarded
    def callback(self, message):
        """Fail."""
        raise ZeroDivisionError(message)

    @logged
    def logged_only(self):
        """Fail off the torque path."""
        raise ZeroDivisionError

    def failed(self, response, message):
        """Fill a refusal."""
        response.message = message
        return response

    @guarded_service
    def service(self, request, response):
        """Fail after the answer was set to success."""
        response.success = True
        raise KeyError('lost')


def test_a_failing_callback_is_logged_with_its_traceback_and_reported():
    broken = Broken()
    assert broken.callback('boom') is None
    assert broken.reported == ['internal error in callback: boom']
    assert 'Traceback' in broken.logged[0]
    assert 'ZeroDivisionError' in broken.logged[0]


def test_a_failing_service_answers_with_failure():
    broken = Broken()
    answer = broken.service(SetBool.Request(), SetBool.Response())
    assert not answer.success
    assert "internal error: 'lost'" in answer.message
    assert 'KeyError' in broken.logged[0]


def test_a_repeated_error_does_not_fill_the_log():
    broken = Broken()
    for _ in range(1000):
        broken.callback('boom')
    assert len(broken.logged) == 1
    assert len(broken.reported) == 1000  # all of them reach the torque path
    assert Broken().callback('boom') is None


def test_an_error_off_the_torque_path_is_only_logged():
    broken = Broken()
    assert broken.logged_only() is None
    assert 'ZeroDivisionError' in broken.logged[0]
    assert broken.reported == []
