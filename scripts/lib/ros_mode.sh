# shellcheck shell=bash
# Where ROS 2 comes from. Sourced by setup.sh.

# Prints where ROS 2 comes from: `wheels` (from PyPI) or `sourced PREFIX`.
ros_mode() {
    case ${ROS_DISTRO:-} in
        '') echo wheels ;;
        jazzy) echo "sourced $(sourced_prefix)" ;;
        *)
            die "expected ROS 2 jazzy or none, got ROS_DISTRO=$ROS_DISTRO: use a shell that has" \
                "sourced /opt/ros/jazzy/setup.bash, or one that has sourced no ROS at all (then" \
                "ROS 2 is installed into .venv)."
            ;;
    esac
}

# The first folder of AMENT_PREFIX_PATH that holds rclpy; nothing if none does.
sourced_prefix() {
    local prefix
    local -a prefixes
    IFS=: read -r -a prefixes <<<"${AMENT_PREFIX_PATH:-}"
    for prefix in "${prefixes[@]}"; do
        if [[ -e $prefix/share/ament_index/resource_index/packages/rclpy ]]; then
            echo "$prefix"
            return
        fi
    done
}
