"""A short run of the latency measurement, with node and relay."""

import contextlib
import math
import os
from pathlib import Path
import signal
import subprocess
import sys

ROOT = Path(__file__).parents[2]
# A separate process: it initializes rclpy.
CODE = """
from benchmarks.node_latency import measure_all, table
rows = measure_all(rates=(50,), slices=2, starts=1, bursts=1, trajectories=1)
for row in rows:
    print(row.name, row.node, row.relay, row.ratio, sep=';')
assert len(table(rows).splitlines()) == len(rows) + 2
"""


def test_every_row_is_measured_and_states_are_answered():
    driver = subprocess.Popen(
        [sys.executable, '-c', CODE],
        cwd=ROOT,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
    )
    try:
        output, problem = driver.communicate(timeout=280.0)
    finally:
        # With the processes that it has started.
        with contextlib.suppress(ProcessLookupError):
            os.killpg(driver.pid, signal.SIGKILL)
    assert driver.returncode == 0, problem
    rows = {}
    for line in output.splitlines():
        name, *values = line.split(';')
        rows[name] = [float(value) for value in values]
    assert list(rows) == [
        'latency p50',
        'latency p90',
        'latency p99',
        'CPU per command',
        'states answered',
        'get_mass_matrix {} p50',
        'get_mass_matrix with position p50',
        'trajectory of 10 000 points',
        'start to first torque, beyond rclpy',
    ]
    assert all(math.isfinite(value) for values in rows.values() for value in values)
    ours, relay, _ = rows['states answered']
    assert ours > 0.5 and relay > 0.5
    # ms: a command that was matched to another state would come before it, or a slice later.
    assert all(0.05 < value < 200.0 for value in rows['latency p50'][:2])
