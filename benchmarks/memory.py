"""Peak memory of a batch besides its result, in a new process."""

import json
from pathlib import Path
import subprocess
import sys

import numpy as np

from .robots import arm7, ROOT


def peak_besides_result(count):
    """
    Measure the peak of resident memory during one batch call.

    Parameters
    ----------
    count : int
        Number of states.

    Returns
    -------
    dict or None
        'result' and 'besides', bytes; None without Linux's /proc.

    """
    run = subprocess.run(
        [sys.executable, '-m', 'benchmarks.memory', str(count)],
        cwd=ROOT,
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode != 0:
        return None
    return json.loads(run.stdout)


def main(count):
    """Print the memory of one batch call, as JSON."""
    robot = arm7()
    robot.model.specialize()
    rng = np.random.default_rng(5)
    Q, QD = rng.uniform(-1.0, 1.0, (2, count, robot.n))
    # Loads the code and starts the threads before the measured call.
    robot.model.dynamics(Q[:1000], QD[:1000])
    # 5 resets the peak to the resident memory.
    Path('/proc/self/clear_refs').write_text('5')
    before = _status('VmRSS')
    result = robot.model.dynamics(Q, QD)
    besides = _status('VmHWM') - before
    size = sum(array.nbytes for array in result)
    json.dump({'result': size, 'besides': besides - size}, sys.stdout)


def _status(key):
    for line in Path('/proc/self/status').read_text().splitlines():
        if line.startswith(f'{key}:'):
            return 1024 * int(line.split()[1])
    raise LookupError(key)


if __name__ == '__main__':
    main(int(sys.argv[1]))
