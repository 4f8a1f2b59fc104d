"""`python -m fuzz`: broken descriptions and joint states through the targets of the node."""

import argparse
import faulthandler
import logging
import os
from pathlib import Path
import random
import sys

from rich.console import Console

from . import description_target, joint_state_target
from .campaign import Campaign
from .report import print_results

_TARGETS = (description_target, joint_state_target)
_FOLDER = Path(__file__).parents[2] / 'log' / 'fuzz'


class _NothingLogged(logging.Handler):
    """Raises at every log line: it means that a library received invalid input."""

    def handle(self, record):
        raise AssertionError(f'{record.name} logs: {record.getMessage()}')


def main(arguments=None):
    """
    Run the campaigns, or repeat one input.

    Returns
    -------
    int
        Exit code: 1 if there are findings.

    """
    parser = argparse.ArgumentParser(prog='python -m fuzz', description=__doc__)
    parser.add_argument(
        '--inputs',
        type=int,
        default=100_000,
        help='half descriptions, half streams of joint states (default: %(default)s)',
    )
    parser.add_argument(
        '--seed',
        type=int,
        help='seed of the inputs (default: 0 where CI is set, otherwise another in every run)',
    )
    parser.add_argument('--replay', type=Path, metavar='FILE', help='only repeat this input')
    parser.add_argument(
        '--folder',
        type=Path,
        default=_FOLDER,
        help='folder for the inputs of findings (default: log/fuzz)',
    )
    options = parser.parse_args(arguments)
    if options.inputs < len(_TARGETS):
        parser.error(f'expected at least {len(_TARGETS)} inputs, got {options.inputs}')
    be_strict()
    if options.replay:
        return _replay(options.replay)
    seed = options.seed
    if seed is None:
        seed = 0 if os.environ.get('CI') else random.SystemRandom().randrange(10**6)
    results = [
        Campaign(target, options.folder).run(
            options.inputs // len(_TARGETS), seed, _print_progress
        )
        for target in _TARGETS
    ]
    print_results(Console(), results, seed)
    return int(any(result.findings for result in results))


def be_strict():
    """Raise at log lines, and do not start other processes."""
    # Code for one robot is compiled in another process.
    os.environ['DYNAMICS_NODE_SPECIALIZE'] = '0'
    logging.getLogger().addHandler(_NothingLogged())
    # A duplicate: standard error is redirected while rclpy may print.
    faulthandler.enable(os.dup(2))


def _replay(path):
    target = next((target for target in _TARGETS if path.suffix == target.SUFFIX), None)
    if target is None:
        print(
            f'error: expected a file ending in {" or ".join(one.SUFFIX for one in _TARGETS)}, '
            f"got '{path}'",
            file=sys.stderr,
        )
        return 2
    target.warm_up()
    print(target.check(target.from_bytes(path.read_bytes())))
    return 0


def _print_progress(text):
    print(text, file=sys.stderr, flush=True)


if __name__ == '__main__':
    sys.exit(main())
