# shellcheck shell=bash disable=SC2034
# Which release of ROS 2 is used, and the folders of its environment. Sourced by base_env.sh and
# setup.sh.
#
# Jazzy has .venv, build and install; every other release has folders with its name behind, so
# that switching between releases builds nothing again. Ends nothing: a user's shell reads this
# too. ros_mode.sh refuses what cannot be used.

# A sourced ROS 2 comes before ROS=name, the release of the Python wheels.
ros_release=${ROS_DISTRO:-${ROS:-jazzy}}
_suffix=
[[ $ros_release == jazzy ]] || _suffix=-$ros_release
# Relative to the checkout.
venv=.venv$_suffix
build_base=build$_suffix
install_base=install$_suffix
unset _suffix
