# shellcheck shell=bash
# What `make shell` reads in place of ~/.bashrc.

# shellcheck source=/dev/null
[[ -f ~/.bashrc ]] && source ~/.bashrc
# shellcheck source=scripts/env.sh
source "$(dirname "${BASH_SOURCE[0]}")/../env.sh"
PS1="(dynamics) ${PS1:-\\w\\$ }"
(
    # shellcheck source=scripts/isolate.sh
    source "$dynamics_root/scripts/isolate.sh"
    echo "make demo and make test use ROS_DOMAIN_ID=$ROS_DOMAIN_ID and" \
        "ROS_AUTOMATIC_DISCOVERY_RANGE=$ROS_AUTOMATIC_DISCOVERY_RANGE: export both to see them from here."
    command -v ros2 >/dev/null ||
        echo "There is no ros2 command here (it is not on PyPI): python -m dynamics_node.ros.main starts the node."
)
