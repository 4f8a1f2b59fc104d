"""The command line of the report."""

import argparse
import math

from .defaults import SAMPLES, SEED

_EXAMPLES = """
examples:
  report my_arm.urdf                          links, joints, gravity torques, what is wrong
  xacro my_arm.urdf.xacro | report -          of a xacro
  report my_arm.urdf --html page.html         one page to show, with plots; needs no network
  report my_arm.urdf --strict                 in CI: fails if there is a problem or a warning
  report my_arm.urdf --json | jq .findings    for programs
  report my_arm.urdf --gravity 9.81 0 0       mounted on a wall
  report my_arm.urdf --payload-link gripper_tcp --payload-point 0 0 0.05

exit codes:
  0  the report was made; with --strict: and there is neither a problem nor a warning (notes
     are fine)
  1  with --strict: there is a problem or a warning, or the robot is refused
  2  there is nothing to report on: wrong arguments, no such file, not a URDF
"""


def parse(arguments=None):
    """
    Read the command line.

    Parameters
    ----------
    arguments : list of str, optional
        Those of the process if not given.

    Returns
    -------
    argparse.Namespace
        robot, json, html, strict, gravity, payload_link, payload_point, samples, seed.

    """
    parser = argparse.ArgumentParser(
        prog='report',
        epilog=_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        description='What a URDF says about the dynamics of a robot, what is wrong with it, and\n'
        'what that does to the torques. Meshes are never opened.',
    )
    parser.add_argument('robot', metavar='ROBOT.urdf', help='a URDF file; - reads standard input')
    parser.add_argument(
        '--json', action='store_true', help='print the report as JSON, and nothing else'
    )
    parser.add_argument(
        '--html', metavar='FILE', help='write one self-contained page with tables and plots'
    )
    parser.add_argument(
        '--strict', action='store_true', help='exit with 1 if there is a problem or a warning'
    )
    parser.add_argument(
        '--gravity',
        nargs=3,
        type=_finite,
        metavar=('X', 'Y', 'Z'),
        default=(0.0, 0.0, -9.81),
        help='m/s^2 in the frame of the root link, points down (default: 0 0 -9.81)',
    )
    parser.add_argument(
        '--payload-link',
        metavar='LINK',
        help='the link that would carry a payload (default: the end of the '
        'arm, before its fingers)',
    )
    parser.add_argument(
        '--payload-point',
        nargs=3,
        type=_finite,
        metavar=('X', 'Y', 'Z'),
        default=(0.0, 0.0, 0.0),
        help='where its mass is in the frame of that link, m (default: 0 0 0)',
    )
    parser.add_argument(
        '--samples',
        type=int,
        default=SAMPLES,
        metavar='N',
        help=f'positions to look at, before the worst are climbed to the top (default: {SAMPLES})',
    )
    parser.add_argument(
        '--seed', type=int, default=SEED, metavar='N', help=f'of these positions (default: {SEED})'
    )
    return parser.parse_args(arguments)


def _finite(text):
    value = float(text)
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f'expected a finite number, got {text}')
    return value
