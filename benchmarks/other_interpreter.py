"""
A library that needs another Python: measured there together with this one, in one process.

The child reads URDF texts as JSON from standard input and writes rows. Both times of a row are
from the child, so their ratio is one of the same process and run.

"""

from dataclasses import asdict
import json
import os
from pathlib import Path
import subprocess
import sys

from . import libraries
from .robots import make_robot, ROOT
from .single_call import measure, Row

# Debian's PyKDL and its library are installed there before a run.
KDL_PYTHON = Path(sys.prefix) / 'kdl' / 'bin' / 'python'


def measure_elsewhere(name, python, robots, rounds):
    """
    Measure one library with another interpreter.

    Parameters
    ----------
    name : str
        File in `libraries/`.
    python : pathlib.Path
        An interpreter with the library and the requirements of this one.
    robots : list of Robot
    rounds : int

    Returns
    -------
    dict
        'rows', 'refused', 'name', 'note', 'version', 'python', 'numpy'.

    Raises
    ------
    RuntimeError
        If the process fails; with its last line.

    """
    job = {
        'name': name,
        'rounds': rounds,
        'robots': [[robot.name, robot.text] for robot in robots],
    }
    environment = dict(os.environ, LD_LIBRARY_PATH=str(python.parents[1] / 'lib'))
    # Variables of this process's Python would mislead the other one.
    for variable in ('PYTHONHOME', 'VIRTUAL_ENV'):
        environment.pop(variable, None)
    environment['PYTHONPATH'] = str(ROOT)
    run = subprocess.run(
        [str(python), '-m', 'benchmarks.other_interpreter'],
        input=json.dumps(job),
        cwd=ROOT,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    if run.returncode != 0:
        lines = run.stderr.strip().splitlines() or ['without a message']
        raise RuntimeError(f'the process of {name} failed: {lines[-1]}')
    result = json.loads(run.stdout)
    result['rows'] = [Row(**row) for row in result['rows']]
    return result


def main():
    """Measure the job on standard input; write the result to standard output."""
    job = json.load(sys.stdin)
    loaded, missing = libraries.load((job['name'],))
    if missing:
        sys.exit(missing[job['name']])
    robots = [make_robot(name, text) for name, text in job['robots']]
    rows, refused = measure(robots, loaded, job['rounds'], say=lambda text: None)
    library = loaded[job['name']]
    json.dump(
        {
            'rows': [asdict(row) for row in rows],
            'refused': refused,
            'name': library.NAME,
            'note': library.NOTE,
            'version': getattr(library, 'VERSION', None) or libraries.version_of(library.PACKAGE),
            'python': '.'.join(map(str, sys.version_info[:3])),
            'numpy': libraries.version_of('numpy'),
        },
        sys.stdout,
    )


if __name__ == '__main__':
    main()
