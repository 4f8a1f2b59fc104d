"""The executor of the command line, and rclpy's own where it does not fit."""

from dynamics_node.ros import executor
from dynamics_node.ros.executor import chosen_executor, EXECUTORS, make_executor
import pytest
import rclpy
from rclpy.executors import SingleThreadedExecutor


def test_the_command_line_chooses_and_what_belongs_to_ros_is_passed_over():
    assert chosen_executor(['node']) == 'lean'
    assert chosen_executor(['node', '--executor', 'rclpy', '--ros-args', '-r', '__ns:=/a']) == (
        'rclpy')
    assert chosen_executor(['node', '--ros-args', '-p', 'a:=1', '--', '--executor=rclpy',
                            '--other']) == 'rclpy'


def test_an_executor_that_does_not_exist_is_refused(capsys):
    with pytest.raises(SystemExit):
        chosen_executor(['node', '--executor', 'fast'])
    assert 'choose from' in capsys.readouterr().err


def test_rclpys_own_is_used_where_the_chosen_one_does_not_fit(monkeypatch):
    rclpy.init()
    try:
        assert isinstance(make_executor('lean', None), EXECUTORS['lean'])
        # As if rclpy had been changed inside.
        monkeypatch.delattr(rclpy.executors.Executor, '_take_timer')
        warnings = []

        class Logger:
            def warning(self, text):
                warnings.append(text)
        chosen = make_executor('lean', Logger())
        assert type(chosen) is SingleThreadedExecutor
        assert warnings == ["executor lean does not work here, rclpy's own is used: expected an "
                            'executor of rclpy 7.1 (Jazzy), got one without _take_timer']
    finally:
        rclpy.shutdown()
    assert executor.EXECUTORS['rclpy'] is SingleThreadedExecutor
