# shellcheck shell=bash disable=SC2154
# Sourced: keeps the demo and the tests of this checkout from hearing, and moving, anything else.
# A domain or a discovery range that the user has set stays.

_checksum=$(cksum <<<"$dynamics_root")
export ROS_DOMAIN_ID=${ROS_DOMAIN_ID:-$((${_checksum%% *} % 101 + 1))}
export ROS_AUTOMATIC_DISCOVERY_RANGE=${ROS_AUTOMATIC_DISCOVERY_RANGE:-LOCALHOST}
unset _checksum
