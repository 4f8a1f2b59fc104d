# shellcheck shell=bash disable=SC2154
# Where ROS 2 comes from. Sourced by setup.sh, after release.sh.

known_releases=(jazzy kilted lyrical rolling)
# Those that PyPI has wheels of: the groups ros-NAME of pyproject.toml.
wheel_releases=(jazzy kilted)

# is_one_of WORD WORDS...
is_one_of() {
    local word=$1 other
    shift
    for other; do
        [[ $word != "$other" ]] || return 0
    done
    return 1
}

# Prints where ROS 2 comes from: `wheels` (from PyPI) or `sourced PREFIX`.
ros_mode() {
    if [[ -n ${ROS_DISTRO:-} ]]; then
        is_one_of "$ROS_DISTRO" "${known_releases[@]}" ||
            die "expected one of the ROS 2 releases ${known_releases[*]} or none, got" \
                "ROS_DISTRO=$ROS_DISTRO: use a shell that has sourced the setup.bash of one of" \
                "them, or one that has sourced no ROS at all (then ROS 2 Jazzy is installed into" \
                ".venv)."
        [[ ${ROS:-$ROS_DISTRO} == "$ROS_DISTRO" ]] ||
            die "expected ROS=$ROS_DISTRO or no ROS=, because this shell has sourced ROS 2" \
                "$ROS_DISTRO, got ROS=$ROS: leave it out, or use a shell that has sourced no ROS."
        echo "sourced $(sourced_prefix)"
        return
    fi
    is_one_of "$ros_release" "${known_releases[@]}" ||
        die "expected ROS= one of ${wheel_releases[*]}, got ROS=$ros_release: no such release of" \
            "ROS 2 is known here; leave ROS= out for jazzy."
    is_one_of "$ros_release" "${wheel_releases[@]}" ||
        die "expected ROS= one of ${wheel_releases[*]}, which PyPI has, got ROS=$ros_release:" \
            "install ROS 2 $ros_release, source its setup.bash and leave ROS= out."
    echo wheels
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
