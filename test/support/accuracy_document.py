"""The text of docs/accuracy.md, from what is measured now."""

from importlib.metadata import version
from pathlib import Path
import platform
import re
from textwrap import fill

from .comparison import CANCELLED
from .cross_library import QUANTITIES, worst_of
from .extreme_robots import extreme_robots
from .extreme_sweep import compare_extreme
from .free_swing import ARMS, SAMPLES, SECONDS, swing, TOLERANCE
from .result_cache import BOUND, STATES, sweep

PATH = Path(__file__).parents[2] / 'docs' / 'accuracy.md'

MACHINE = '## Measured with'
_PACKAGES = ('numpy', 'numba', 'scipy', 'pin', 'mujoco', 'example-robot-data')


def render():
    """Return the text of the document, from what is measured now."""
    rows, left_out = sweep()
    extremes = [compare_extreme(name) for name in extreme_robots()]
    parts = [
        _introduction(rows, left_out),
        _robots(rows),
        _left_out(left_out),
        _judges(rows),
        _extremes(extremes),
        _swings(),
        _machine(),
    ]
    return '\n\n'.join(parts) + '\n'


def _introduction(rows, left_out):
    return '\n'.join(
        [
            '# Accuracy',
            '',
            _text(
                'How far D, C, G, inverse dynamics (ID), forward dynamics (FD) and the energies '
                'of `RobotModel` differ from other implementations, on every URDF of the package '
                f'`example-robot-data`: {len(rows)} robots are compared, {len(left_out)} are left '
                'out, with reasons. Every robot is fixed at its root link, including legged and '
                'flying ones. Each reference reads the file itself:'
            ),
            '',
            _text(
                '- **Pinocchio**, a rigid body library: its mass and Coriolis matrices, recursive '
                'Newton-Euler, articulated bodies;'
            ),
            _text(
                '- **MuJoCo**, a physics engine, without contacts, limits, damping and friction;'
            ),
            _text(
                '- **80 bits**: the sums of [the mathematics](mathematics.md), section 3, '
                'computed literally in arithmetic with 2000 times less rounding. It decides which '
                'result is wrong if two differ.'
            ),
            '',
            _text(
                f'A figure is the largest relative error of any element at {STATES} random '
                'states, all joints moving: the difference divided by the element, or by '
                f'{CANCELLED} of the size of its summands (by Cauchy and Schwarz) if they cancel '
                f'to less than that. The bound is {_number(BOUND)}. With mimic joints, the '
                'accelerations of the references are solved from their own D and bias.'
            ),
            '',
            _text(
                'Written by `scripts/write_accuracy.py`. `make test` measures everything again '
                'and fails if this page is no longer true.'
            ),
        ]
    )


def _robots(rows):
    lines = [
        '## Public robots',
        '',
        'Six columns against Pinocchio; against MuJoCo and 80 bits, the worst of the six.',
        '',
        '| robot | joints | D | C | G | ID | FD | energy | MuJoCo | 80 bits |',
        '|---|---|---|---|---|---|---|---|---|---|',
    ]
    for row in rows:
        joints = f'{row.joints} + {row.mimics} mimic' if row.mimics else f'{row.joints}'
        lines.append(
            _cells(
                _short(row.name),
                joints,
                *_six(row.errors['library', 'pinocchio']),
                *(_number(_worst(row, ('library', judge))) for judge in ('mujoco', 'exact')),
            )
        )
    worst = worst_of(row.errors['library', 'pinocchio'] for row in rows)
    lines.append(
        _cells(
            '**worst**',
            '',
            *_six(worst),
            *(
                _number(max(_worst(row, ('library', judge)) for row in rows))
                for judge in ('mujoco', 'exact')
            ),
        )
    )
    return '\n'.join(lines)


def _left_out(left_out):
    return '\n'.join(
        ['## Left out', '', *(f'- `{robot.name}`: {robot.reason}' for robot in left_out)]
    )


def _judges(rows):
    lines = [
        '## Which result is wrong',
        '',
        f'Every difference from Pinocchio above {_number(BOUND)}, and the error of each against '
        '80 bits there:',
        '',
        '| robot | what | ours | Pinocchio | MuJoCo |',
        '|---|---|---|---|---|',
    ]
    for row in rows:
        for name in row.errors['library', 'exact']:
            if row.errors['library', 'pinocchio'][name] > BOUND:
                lines.append(
                    _cells(
                        _short(row.name),
                        name,
                        *(
                            _number(row.errors[route, 'exact'][name])
                            for route in ('library', 'pinocchio', 'mujoco')
                        ),
                    )
                )
    hard = max((row for row in rows if row.plain), key=lambda row: row.plain['library'])
    refused = [row for row in rows if row.replaced]
    idle = [_short(row.name) for row in rows if not row.plain]
    return '\n'.join(
        [
            *lines,
            '',
            _text(
                '- Pinocchio sums its C in the base frame, and MuJoCo sums all quantities about '
                'the center of mass of the whole robot; a light link far from there loses digits '
                'in the difference of large moments. Here each joint has its own frame.'
            ),
            _text(
                '- MuJoCo has no C. The Christoffel matrix is a difference of its bias at several '
                'speeds, which costs some more digits.'
            ),
            _text(
                f'- MuJoCo refuses links of {len(refused)} of these robots, because of physically '
                'impossible inertia or moving links without mass. For these, the numbers of the '
                'file are written into its model.'
            ),
            _text(
                f'- FD is undefined on {", ".join(idle)}: a joint moves no inertia. '
                '`forward_dynamics` raises an error.'
            ),
            _text(
                '- Plain relative errors of the largest acceleration are larger if D is '
                f'ill-conditioned: the worst is {_short(hard.name)} (condition '
                f'{_number(hard.condition)}) with {_number(hard.plain["library"])} for ours, '
                f'{_number(hard.plain["pinocchio"])} for Pinocchio and '
                f'{_number(hard.plain["mujoco"])} for MuJoCo.'
            ),
        ]
    )


def _extremes(rows):
    lines = [
        '## Extreme robots',
        '',
        'Against 80 bits: ours in six columns, the worst of the six for the others. No result '
        'is NaN.',
        '',
        '| robot | condition of D | D | C | G | ID | FD | energy | Pinocchio | MuJoCo |',
        '|---|---|---|---|---|---|---|---|---|---|',
    ]
    for row in rows:
        others = (_number(_worst(row, (judge, 'exact'))) for judge in ('pinocchio', 'mujoco'))
        lines.append(
            _cells(
                row.name, _number(row.condition), *_six(row.errors['library', 'exact']), *others
            )
        )
    return '\n'.join(
        [
            *lines,
            '',
            _text(
                "At the end of a boom, the product of the tip's speed and the first moment of its "
                'load cancels in C. This costs digits unless velocities count from each joint, as '
                'here: equation (24) of [the mathematics](mathematics.md).'
            ),
        ]
    )


def _swings():
    lines = [
        '## A free swing',
        '',
        _text(
            f'An arm released from rest for {SECONDS:g} s with its fingers fixed, without efforts '
            'and without damping, integrated with `forward_dynamics` (DOP853, tolerance '
            f'{_number(TOLERANCE)} per step). Drift: the largest change of the total energy, '
            'divided by the largest kinetic energy; it comes from the integrator and shrinks with '
            f'its tolerance. MuJoCo: the error of the acceleration at {SAMPLES} states of the '
            'motion.'
        ),
        '',
        '| arm | largest kinetic energy, J | drift | acceleration against MuJoCo |',
        '|---|---|---|---|',
    ]
    for name in ARMS:
        result = swing(name)
        lines.append(
            _cells(name, f'{result.kinetic:.1e}', _number(result.drift), _number(result.mujoco))
        )
    return '\n'.join(lines)


def _machine():
    packages = ', '.join(f'{name} {version(name)}' for name in _PACKAGES)
    return f'{MACHINE}\n\n' + _text(
        f'{_processor()}, {platform.system()}, Python {platform.python_version()}, {packages}.'
    )


def _processor():
    info = Path('/proc/cpuinfo')
    found = re.search(r'model name\s*:\s*(.*)', info.read_text()) if info.exists() else None
    return found[1] if found else platform.machine()


def _six(errors):
    return [_number(errors[name]) if name in errors else '–' for name in QUANTITIES]


def _worst(row, pair):
    return max(row.errors[pair].values())


def _text(sentences):
    return fill(
        sentences,
        width=99,
        subsequent_indent='  ' if sentences[:2] == '- ' else '',
        break_on_hyphens=False,
        break_long_words=False,
    )


def _number(value):
    return f'{value:.0e}'


def _cells(*cells):
    return '| ' + ' | '.join(cells) + ' |'


def _short(name):
    return Path(name).stem if Path(name).stem != 'anymal' else name.split('_simple')[0]
