"""
A library that needs another Python: measured in a process of its own, this library beside it.

The child gets the URDF texts as JSON on its standard input and answers with rows; both
libraries' times in a row are from the child, so their ratio is of one process and one run.

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

# `scripts/lib/rivals.sh` puts Debian's PyKDL and its library there.
KDL_PYTHON = Path(sys.prefix) / 'kdl' / 'bin' / 'python'


def measure_beside(name, python, robots, rounds):
    """
    Measure one library in a process of its own.

    Parameters
    ----------
    name : str
        File in `rivals/`.
    python : pathlib.Path
        The interpreter that has the library and what this one needs.
    robots : list of Robot
    rounds : int

    Returns
    -------
    dict
        'rows', 'refused', 'name', 'note', 'version', 'python', 'numpy'.

    Raises
    ------
    RuntimeError
        If the process fails; with the last line that it said.

    """
    job = {
        'name': name,
        'rounds': rounds,
        'robots': [[robot.name, robot.text] for robot in robots],
    }
    environment = dict(os.environ, LD_LIBRARY_PATH=str(python.parents[1] / 'lib'))
    # What was sourced for this process's Python is of no use to another one.
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
        lines = run.stderr.strip().splitlines() or ['it said nothing']
        raise RuntimeError(f'the process of {name} failed: {lines[-1]}')
    answer = json.loads(run.stdout)
    answer['rows'] = [Row(**row) for row in answer['rows']]
    return answer


def main():
    """Do the job on standard input; answer on standard output."""
    job = json.load(sys.stdin)
    loaded, missing = libraries.load((job['name'],))
    if missing:
        sys.exit(missing[job['name']])
    robots = [make_robot(name, text) for name, text in job['robots']]
    rows, refused = measure(robots, loaded, job['rounds'], say=lambda text: None)
    rival = loaded[job['name']]
    json.dump(
        {
            'rows': [asdict(row) for row in rows],
            'refused': refused,
            'name': rival.NAME,
            'note': rival.NOTE,
            'version': getattr(rival, 'VERSION', None) or libraries.version_of(rival.PACKAGE),
            'python': '.'.join(map(str, sys.version_info[:3])),
            'numpy': libraries.version_of('numpy'),
        },
        sys.stdout,
    )


if __name__ == '__main__':
    main()
