"""No exception leaves a callback."""

from dynamics_node.ros.support.callback_errors import guarded, guarded_service, logged
from std_srvs.srv import SetBool


class Broken:
    """Callbacks that fail, and what was told about it."""

    def __init__(self):
        self.logger = self
        self.logged, self.told = [], []
        self.error = self.logged.append
        self.on_internal_error = self.told.append

    @guarded
    def callback(self, message):
        """Fail."""
        raise ZeroDivisionError(message)

    @logged
    def aside(self):
        """Fail where it does not matter."""
        raise ZeroDivisionError

    def failed(self, response, message):
        """Answer."""
        response.message = message
        return response

    @guarded_service
    def service(self, request, response):
        """Fail after having promised success."""
        response.success = True
        raise KeyError('lost')


def test_a_failing_callback_is_logged_with_its_traceback_and_told():
    broken = Broken()
    assert broken.callback('boom') is None
    assert broken.told == ['internal error in callback: boom']
    assert 'Traceback' in broken.logged[0]
    assert 'ZeroDivisionError' in broken.logged[0]


def test_a_failing_service_answers_that_it_failed():
    broken = Broken()
    answer = broken.service(SetBool.Request(), SetBool.Response())
    assert not answer.success
    assert "internal error: 'lost'" in answer.message
    assert 'KeyError' in broken.logged[0]


def test_an_error_that_keeps_coming_does_not_fill_the_log():
    broken = Broken()
    for _ in range(1000):
        broken.callback('boom')
    assert len(broken.logged) == 1
    assert len(broken.told) == 1000  # the torque path hears of every one
    assert Broken().callback('boom') is None


def test_a_callback_that_no_torque_depends_on_is_only_logged():
    broken = Broken()
    assert broken.aside() is None
    assert 'ZeroDivisionError' in broken.logged[0]
    assert broken.told == []
