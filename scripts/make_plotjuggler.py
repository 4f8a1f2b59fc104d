#!/usr/bin/env python3
"""
Write a PlotJuggler layout for a robot: gravity and external torque of every joint.

Without arguments it writes config/plotjuggler.xml for config/robots/arm7.urdf. For another robot
or a namespace, in `make shell`:

    python scripts/make_plotjuggler.py my_arm.urdf my_arm.xml
    python scripts/make_plotjuggler.py my_arm.urdf left.xml --namespace left
    ros2 run plotjuggler plotjuggler --layout my_arm.xml

"""

import argparse
from pathlib import Path
import sys
from xml.etree import ElementTree as ET

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT))

from dynamics_node import DynamicsError, RobotModel  # noqa: E402

ARM7 = ROOT / 'config' / 'robots' / 'arm7.urdf'
OUTPUT = ROOT / 'config' / 'plotjuggler.xml'
STREAMER = 'ROS2 Topic Subscriber'
# Colors of lines, used in turn.
COLORS = ('#1f77b4', '#d62728', '#1ac938', '#ff7f0e', '#f14cc1', '#9467bd', '#17becf', '#bcbd22')
COMMENT = """
  PlotJuggler 3: gravity torque and external torque of every joint. Written by
  scripts/make_plotjuggler.py, which also writes one for another robot or namespace.
  It needs the plugin for ROS 2 (plotjuggler_ros); external torque needs the node's parameter
  publish_external_torque. Open it with File / Layout, start the stream, choose the two topics.
"""


def main(arguments=None):
    """Write a layout; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.strip().splitlines()[0])
    parser.add_argument('urdf', nargs='?', default=ARM7, help='robot; default: arm7')
    parser.add_argument('output', nargs='?', default=OUTPUT, help='file to write')
    parser.add_argument('--namespace', default='', help='namespace of the node')
    options = parser.parse_args(arguments)
    try:
        names = RobotModel.from_urdf(options.urdf).joint_names
    except (DynamicsError, OSError) as error:
        print(f'make_plotjuggler: {error}', file=sys.stderr)
        return 1
    Path(options.output).write_text(layout(names, options.namespace), encoding='utf-8')
    print(f'wrote {options.output}')
    return 0


def layout(names, namespace=''):
    """
    Return a layout.

    Parameters
    ----------
    names : sequence of str
        Joints of the node.
    namespace : str
        Namespace of the node.

    Returns
    -------
    str
        XML in the format of PlotJuggler 3.

    """
    node = '/'.join(['', *filter(None, namespace.split('/')), 'dynamics_node'])
    topics = [f'{node}/gravity_torque', f'{node}/external_torque']
    root = ET.Element('root')
    root.append(ET.Comment(COMMENT))
    window = ET.SubElement(root, 'tabbed_widget', name='Main Window', parent='main_window')
    _tab(
        window,
        'all joints',
        [
            (
                topic.rpartition('/')[2].replace('_', ' '),
                [_curve(topic, name) for name in names],
                COLORS,
            )
            for topic in topics
        ],
    )
    _tab(
        window,
        'joint by joint',
        [(name, [_curve(topic, name) for topic in topics], COLORS) for name in names],
    )
    ET.SubElement(window, 'currentTabIndex', index='0')
    ET.SubElement(root, 'use_relative_time_offset', enabled='1')
    ET.SubElement(root, 'streaming_buffer_size', value='30')
    _plugins(root, topics)
    ET.indent(root, ' ')
    return "<?xml version='1.0' encoding='UTF-8'?>\n" + ET.tostring(root, 'unicode') + '\n'


def _curve(topic, joint):
    # PlotJuggler's name of an effort of a sensor_msgs/JointState.
    return f'{topic}/{joint}/effort'


def _tab(window, name, plots):
    tab = ET.SubElement(window, 'Tab', tab_name=name, containers='1')
    container = ET.SubElement(tab, 'Container')
    columns = [plots] if len(plots) <= 4 else [plots[::2], plots[1::2]]
    across = _splitter(container, '|', len(columns))
    for column in columns:
        # PlotJuggler puts a single area directly into the outer splitter.
        parent = across if len(column) == 1 else _splitter(across, '-', len(column))
        for title, curves, colors in column:
            _plot(parent, title, curves, colors)


def _splitter(parent, orientation, count):
    return ET.SubElement(
        parent,
        'DockSplitter',
        orientation=orientation,
        count=str(count),
        sizes=';'.join([f'{1 / count:.6g}'] * count),
    )


def _plot(parent, title, curves, colors):
    area = ET.SubElement(parent, 'DockArea', name=title)
    plot = ET.SubElement(
        area,
        'plot',
        mode='TimeSeries',
        style='Lines',
        line_width='1.0',
        flip_x='false',
        flip_y='false',
    )
    ET.SubElement(
        plot, 'range', left='0.000000', right='30.000000', bottom='-1.000000', top='1.000000'
    )
    ET.SubElement(plot, 'limitY')
    for i, curve in enumerate(curves):
        ET.SubElement(plot, 'curve', name=curve, color=colors[i % len(colors)])


def _plugins(root, topics):
    plugin = ET.SubElement(ET.SubElement(root, 'Plugins'), 'plugin', ID=STREAMER)
    for name, value in (
        ('use_header_stamp', 'true'),
        ('discard_large_arrays', 'true'),
        ('max_array_size', '100'),
        ('boolean_strings_to_number', 'true'),
        ('remove_suffix_from_strings', 'true'),
        ('selected_topics', ';'.join(topics)),
    ):
        ET.SubElement(plugin, name, value=value)
    ET.SubElement(root, 'previouslyLoaded_Streamer', name=STREAMER)


if __name__ == '__main__':
    sys.exit(main())
