"""The options of the process."""

from dynamics_node.ros.support.command_line import parse
import pytest


def test_the_options_are_read_and_what_belongs_to_ros_is_passed_over():
    assert vars(parse(['node'])) == {'executor': 'rclpy', 'raw_states': True}
    chosen = {'executor': 'events', 'raw_states': False}
    assert (
        vars(
            parse(
                ['node', '--executor', 'events', '--no-raw-states', '--ros-args', '-r', '__ns:=/a']
            )
        )
        == chosen
    )
    assert (
        vars(
            parse(
                [
                    'node',
                    '--ros-args',
                    '-p',
                    'a:=1',
                    '--',
                    '--executor=events',
                    '--no-raw-states',
                    '--other',
                ]
            )
        )
        == chosen
    )


def test_an_executor_that_does_not_exist_is_refused(capsys):
    with pytest.raises(SystemExit):
        parse(['node', '--executor', 'fast'])
    assert 'choose from' in capsys.readouterr().err
