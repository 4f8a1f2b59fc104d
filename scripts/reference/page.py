"""docs/reference.md as text."""

from pathlib import Path
import re

from dynamics_node.ros.effort_guard.parameters import GUARD_PARAMETERS
from dynamics_node.ros.parameters.table import PARAMETERS
from dynamics_node.ros.support.command_line import parser

from . import graph, interfaces, launch_files

ROOT = Path(__file__).resolve().parents[2]
PATH = ROOT / 'docs' / 'reference.md'
INTERFACES = ROOT / 'dynamics_interfaces'

HEAD = """# Reference

Written by `scripts/write_reference.py` from the parameter tables, the interface files and the
launch files; do not edit by hand. A test compares it with a running node.

Units are SI. Names are relative or private (`~` is the node, `/dynamics_node` by default), so
namespaces and remapping work. n is the number of joints, in the order of the parameter
`joints`. A joint outside `joints` still carries mass: it stands at its measured position or,
before the first measurement, at its neutral one (zero, or the nearest value within the limits).

[Topics](#topics) · [Services](#services) · [Parameters](#parameters) · [Programs and launch
files](#programs-and-launch-files) · [Effort guard](#effort-guard) ·
[Messages](#messages) · [Service types](#service-types)"""

EXTERNAL_TORQUE = """**External torque.** With `publish_external_torque: true`,
`~/external_torque` is the external torque on each joint, N m or N. joint_states needs velocities,
and efforts that are joint torques with gravity
([from which drivers](arms.md#whose-efforts-are-torques)); `/diagnostics` reports missing or
implausible inputs. An unknown payload or friction counts as an external torque. States must
arrive at more than 10 Hz; partial states count when all joints have arrived."""

SERVICES = """All answer `success` and `message`; on failure every array is empty. The empty
request `{}` asks for the newest measured position, at rest; `position` and `velocity` ask for
another state, `joint_names` for another order. Matrices are row-major. While efforts are sent, a
request waits up to 0.1 s to give the torque precedence, and further requests within 0.25 s do not
wait; `~/enable` never waits."""

PARAMETERS_TEXT = """A commented file with all of them:
[config/dynamics.yaml](../config/dynamics.yaml). Wrong values are refused with the reason, at the
start and at run time. Read-only parameters are set at the start. The node also has the parameters
of every ROS 2 node: `use_sim_time` (on both sides, if a simulation publishes `/clock`),
`start_type_description_service`, and `qos_overrides./joint_states.subscription.*` (`reliability`,
`depth`, `history`, `durability`; the topic's resolved name stands in the middle). To receive a
state that was published before the node started, it needs both `durability:=transient_local` and
`reliability:=reliable`."""

PROGRAMS = """| command | program |
|---|---|
| `ros2 run dynamics_node dynamics_node` | the node |
| `ros2 run dynamics_node markers` | [markers](#markers-program) of the node for RViz |
| `ros2 run dynamics_node report my_arm.urdf` | [contents and errors](report.md) of a URDF |
| `ros2 run dynamics_node effort_guard` | [fades the effort](effort_guard.md) when the node dies |
| `ros2 run dynamics_node simulated_robot` | an arm in MuJoCo with brakes, for a first try |
| `ros2 run dynamics_node demo` | the demo: `make demo` without make |

Where ROS 2 comes from PyPI there is no `ros2` command; `python -m dynamics_node.ros.main`,
`python -m dynamics_node.visualization.markers`, `python -m dynamics_node.report`,
`python -m dynamics_node.ros.effort_guard.main`, `python -m dynamics_node.demo.simulated_robot`
and `python -m dynamics_node.demo.__main__` are the same programs."""

MARKERS = """`ros2 run dynamics_node markers` draws for one dynamics node, in a separate process.
Its only parameter, `dynamics_node`, is the name of that node (default `dynamics_node`), relative
to the namespace of the program; read-only. It is `<node>` in the table."""

OPTIONS = """`--executor events` is refused, with the reason, where its self-test at start fails:
before rclpy 7.1.11 it runs no asynchronous callback, and some builds of it wait with a busy core.
`--no-raw-states` costs latency and processor time."""

EFFORT_GUARD = """The program `effort_guard` is a separate process, the node
`/effort_guard`. [How to use it](effort_guard.md)."""

EFFORT_GUARD_PARAMETERS = """Its parameters are all read-only: they are set at the start. As soon
as the controller behind it has answered, it also offers the controller's `joints` and
`interface_name`; they cannot be set."""


def render():
    """
    Return the page.

    Returns
    -------
    str
        Markdown.

    """
    return (
        '\n\n'.join(
            [
                HEAD,
                '## Topics',
                '### Subscribed',
                _entries('topic', 'notes', graph.SUBSCRIBED),
                '### Published',
                _entries('topic', 'when', graph.PUBLISHED),
                EXTERNAL_TORQUE,
                '## Services',
                SERVICES,
                _entries('service', 'response', graph.SERVICES),
                '## Parameters',
                PARAMETERS_TEXT,
                _parameters(PARAMETERS),
                '## Programs and launch files',
                PROGRAMS,
                *_launch_files(),
                'Options of the process, not parameters: `ros2 run dynamics_node dynamics_node '
                '--no-raw-states`.',
                _options(),
                OPTIONS,
                '## Effort guard',
                EFFORT_GUARD,
                _entries('topic or service', 'content', graph.EFFORT_GUARD),
                EFFORT_GUARD_PARAMETERS,
                _parameters(GUARD_PARAMETERS),
                '### Markers program',
                MARKERS,
                _entries('name', 'notes', graph.MARKERS),
                '## Messages',
                *_interfaces('msg', [None]),
                '## Service types',
                *_interfaces('srv', ['request', 'response']),
            ]
        )
        + '\n'
    )


def _table(headings, rows):
    lines = ['| ' + ' | '.join(headings) + ' |', '|' + '---|' * len(headings)]
    return '\n'.join([*lines, *('| ' + ' | '.join(row) + ' |' for row in rows)])


def _entries(title, words, entries):
    return _table(
        [title, 'type', words],
        [[f'`{entry.name}`', _linked(entry.kind), entry.words] for entry in entries],
    )


def _linked(kind):
    """Return a type, linked to its fields if they are on this page."""
    name = kind.rpartition('/')[2]
    return f'[{kind}](#{name.lower()})' if kind.startswith('dynamics_interfaces/') else kind


def shown(default):
    """
    Return a parameter's default as on the command line.

    Parameters
    ----------
    default : bool, float, str or tuple

    Returns
    -------
    str

    """
    if isinstance(default, bool):
        return str(default).lower()
    if isinstance(default, tuple):
        return str(list(default))
    return "''" if default == '' else str(default)


def _parameters(parameters):
    rows = []
    for parameter in parameters:
        accepts = parameter.constraints()
        notes = [
            parameter.description,
            f'Accepts {accepts}' if accepts else '',
            'Read-only' if parameter.read_only else '',
        ]
        rows.append(
            [
                f'`{parameter.name}`',
                parameter.kind,
                f'`{shown(parameter.default)}`',
                _coded('. '.join(note for note in notes if note)),
            ]
        )
    return _table(['name', 'type', 'default', 'meaning'], rows)


def _coded(words):
    """Mark tags and names with underscores as code, which Markdown would interpret."""
    return re.sub(r'(<[a-z][^<>=]*>|~/\w+|\b[a-z]+(?:_[a-z]+)+(?:\.[a-z]+)?\b)', r'`\1`', words)


def _launch_files():
    parts = []
    for path in sorted((ROOT / 'launch').glob('*.launch.py')):
        introduction, arguments = launch_files.read(path)
        parts.append(f'`ros2 launch dynamics_node {path.name}`: {introduction}')
        if arguments:
            parts.append(
                _table(
                    ['argument', 'meaning'],
                    [[f'`{argument.name}:=`', argument.words] for argument in arguments],
                )
            )
    return parts


def _options():
    return _table(
        ['option', 'meaning'],
        [
            [', '.join(f'`{flag}`' for flag in action.option_strings), action.help]
            for action in parser()._actions
            if action.dest != 'help'
        ],
    )


def _interfaces(folder, titles):
    parts = []
    for path in sorted((INTERFACES / folder).glob(f'*.{folder}')):
        interface = interfaces.read(path)
        parts += [f'### {interface.title}', ' '.join(interface.introduction)]
        for title, fields in zip(titles, interface.parts, strict=True):
            parts.append(
                _table(
                    [title or 'field', 'type', 'meaning'],
                    [
                        [
                            f'`{item.name}`' + (f' = {item.value}' if item.value else ''),
                            item.kind,
                            item.words,
                        ]
                        for item in fields
                    ],
                )
            )
    return parts
