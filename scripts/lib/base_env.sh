# shellcheck shell=bash disable=SC2154
# Sourced by env.sh and setup.sh: the environment below the packages of this checkout, that is
# the virtual environment and ROS 2. Needs `dynamics_root`, the checkout.

# prepend_path VARIABLE FOLDER: put it in front, once.
prepend_path() {
    local rest=:${!1:-}:
    rest=${rest//":$2:"/:}
    rest=${rest#:}
    rest=${rest%:}
    export "$1=$2${rest:+:$rest}"
}

# shellcheck source=scripts/lib/release.sh
source "$dynamics_root/scripts/lib/release.sh"
export VIRTUAL_ENV=$dynamics_root/$venv
prepend_path PATH "$VIRTUAL_ENV/bin"
unset PYTHONHOME

# ROS 2 from wheels lies in the virtual environment. A sourced ROS 2 has set all of this itself.
for _site in "$VIRTUAL_ENV"/lib/python3.*/site-packages; do
    if [[ -d $_site/ros_wheels_bootstrapper ]]; then
        prepend_path AMENT_PREFIX_PATH "$VIRTUAL_ENV"
        prepend_path CMAKE_PREFIX_PATH "$VIRTUAL_ENV"
        for _libraries in "$_site"/ros_*.libs; do
            [[ -d $_libraries ]] && prepend_path LD_LIBRARY_PATH "$_libraries"
        done
        prepend_path LD_LIBRARY_PATH "$VIRTUAL_ENV/lib"
        # The wheels start Python twice, to set LD_LIBRARY_PATH, unless this says that it is
        # set. It must be in any case: a colcon workspace that is sourced changes it too.
        export _ROS_WHEELS_BOOTSTRAP_COMPLETE=1
        # The wheels have no other middleware.
        export RMW_IMPLEMENTATION=rmw_fastrtps_cpp
    fi
done
unset _site _libraries
