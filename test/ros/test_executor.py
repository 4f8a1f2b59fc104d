"""The chosen executor, and rclpy's own where that one does not fit."""

from dynamics_node.ros.executor import EXECUTORS, make_executor
import rclpy
from rclpy.executors import SingleThreadedExecutor


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
