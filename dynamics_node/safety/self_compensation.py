"""Arms whose drivers compensate gravity themselves, by the plugin that their URDF names."""

import re

# Package of the ros2_control hardware plugin → arm. docs/arms.md has the sources.
SELF_COMPENSATING = {
    'franka_gz_ros2_control': 'a simulated Franka arm',
    'franka_hardware': 'a Franka arm',
    'franka_ign_ros2_control': 'a simulated Franka arm',
    'iiwa_hardware': 'a KUKA LBR iiwa',
    'kuka_sunrise_fri_driver': 'a KUKA LBR iiwa',
    'lbr_ros2_control': 'a KUKA LBR iiwa',
    'trossen_arm_hardware': 'a Trossen arm',
    'ur_robot_driver': 'a Universal Robots arm',
    'ur_robot_driver_cb2': 'a Universal Robots arm',
}


def self_compensating(plugins):
    """
    Return which hardware plugins drive an arm that compensates gravity itself.

    Parameters
    ----------
    plugins : sequence of str
        As the URDF names them, 'package/Class' or 'package::Class'.

    Returns
    -------
    list of str
        'plugin (arm)' each; empty if there is none.

    """
    return [
        f'{plugin} ({SELF_COMPENSATING[package]})'
        for plugin in plugins
        if (package := re.split('/|::', plugin, maxsplit=1)[0]) in SELF_COMPENSATING
    ]
