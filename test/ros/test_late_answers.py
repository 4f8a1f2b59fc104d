"""A service that answers later, called over DDS."""

from types import SimpleNamespace

from dynamics_node.ros.late_answers import LateAnswers
import pytest
from std_srvs.srv import SetBool
from support.processes import Client


@pytest.fixture
def other():
    """Return a second client, which has the service."""
    other = Client()
    yield other
    other.close()


def asked(client, other, callback):
    """Call a service with a callback; return the future and what drives both sides."""
    LateAnswers(other.node, SetBool, 'ask', callback)
    service = client.node.create_client(SetBool, 'ask')

    def spin():
        other.executor.spin_once(timeout_sec=0.0)
    client.until(service.service_is_ready, spin)
    return service.call_async(SetBool.Request(data=True)), spin


def test_an_answer_may_come_at_once(client, other):
    future, spin = asked(client, other, lambda request, answer: answer.give(
        request.data, 'at once'))
    client.until(future.done, spin)
    assert future.result() == SetBool.Response(success=True, message='at once')


def test_an_answer_may_come_later_and_only_the_first_one_counts(client, other):
    kept = []
    future, spin = asked(client, other, lambda request, answer: kept.append(answer))
    client.until(lambda: kept, spin)
    client.during(0.1, spin)
    assert not future.done()
    kept[0].give(True, 'later')
    kept[0].give(False, 'still later')
    client.until(future.done, spin)
    assert future.result() == SetBool.Response(success=True, message='later')


def test_a_callback_that_raises_is_an_answer_too(client, other):
    def fail(request, answer):
        raise KeyError('lost')
    future, spin = asked(client, other, fail)
    client.until(future.done, spin)
    assert not future.result().success
    assert future.result().message == "internal error: 'lost'"


def test_an_answer_that_cannot_be_sent_is_logged(client):
    def refuse(response, header):
        raise RuntimeError('nobody there')
    warnings = []
    service = SimpleNamespace(srv_name='/ask', send_response=refuse)
    node = SimpleNamespace(get_logger=lambda: SimpleNamespace(warning=warnings.append),
                           create_service=lambda *_: service)
    answers = LateAnswers(node, SetBool, 'ask', lambda request, answer: answer.give(True, 'yes'))
    service.send_response(answers._called(SetBool.Request(), SetBool.Response()), 'header')
    assert warnings == ['/ask: the answer cannot be sent: nobody there']
