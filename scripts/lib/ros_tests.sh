# shellcheck shell=bash disable=SC2034
# The tests that need ROS 2: what `make test ROS=kilted` runs. The others test the library, which
# is the same on every release. Sourced by test.sh.
ros_tests=(
    test/ros
    test/tools
    test/demo
    test/visualization
    test/benchmarks/test_node_latency.py
    test/safety/test_state_machine.py
    test/test_commands_in_documents.py
    test/test_launch.py
    test/test_mass_matrix_document.py
    test/test_reference_document.py
    test/test_robot_configs.py
    test/test_safety_document.py
    test/test_trajectory_document.py
)
