"""`python -m soak`: a simulated arm with random faults, and a verdict as exit code."""

import argparse
import random
import sys
import time

from rich.console import Console

from .faults import STATE_TIMEOUT
from .report import failures, print_report
from .rig import Rig
from .soak import Soak


def main(arguments=None):
    """Run the soak; return 0 if nothing was lost, leaked or out of limits."""
    options = _options(arguments)
    console = Console(highlight=False, markup=False, width=None if sys.stdout.isatty() else 100)
    console.print(
        f'A simulated arm at {options.rate:g} Hz for {options.minutes:g} minutes, '
        f'seed {options.seed}'
    )
    rig = Rig(options.rate, options.seed, state_timeout=STATE_TIMEOUT)
    try:
        soak = Soak(rig, random.Random(options.seed), console.print)
        try:
            soak.run(60.0 * options.minutes)
        except AssertionError as error:
            for name in ('robot', 'relay', 'node'):
                console.print(f'--- last lines of {name} ---')
                console.print('\n'.join(rig.processes.lines(name)[-15:]))
            console.print(f'soak failed: {error}')
            return 1
        print_report(console, soak, rig.client, options.seed)
        problems = failures(soak, rig.client)
    finally:
        rig.close()
    for failure in problems:
        console.print(f'soak failed: {failure}')
    if not problems:
        console.print('Nothing lost, nothing leaked, nothing out of limits.')
    return 1 if problems else 0


def _options(arguments):
    parser = argparse.ArgumentParser(prog='python -m soak', description=__doc__)
    parser.add_argument('--minutes', type=float, default=10.0, help='default: 10')
    parser.add_argument(
        '--rate',
        type=float,
        default=500.0,
        metavar='HZ',
        help='rate of the joint states (default: 500)',
    )
    parser.add_argument(
        '--seed',
        type=int,
        default=int(time.time()) % 100_000,
        help='seed of kind and time of the faults (default: a new one)',
    )
    return parser.parse_args(arguments)


if __name__ == '__main__':
    sys.exit(main())
