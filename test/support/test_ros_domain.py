"""Claims of ROS domains."""

import subprocess
import sys

from support.robots import ROBOTS
from support.ros_domain import claim, DOMAINS

CODE = 'from support.ros_domain import claim; print(claim())'


def claimed(chosen):
    """Return the domain claimed by another process, which then ends."""
    return int(
        subprocess.run(
            [sys.executable, '-c', CODE],
            cwd=ROBOTS.parents[1] / 'test',
            text=True,
            check=True,
            env={'ROS_DOMAIN_ID': str(chosen)},
            stdout=subprocess.PIPE,
        ).stdout
    )


def test_every_claim_is_another_valid_domain_also_in_other_processes():
    mine = [claim() for _ in range(3)]
    assert len(set(mine)) == 3
    assert all(1 <= domain <= DOMAINS for domain in mine)
    for chosen in mine:
        assert claimed(chosen) not in mine


def test_the_chosen_domain_is_taken_if_it_is_free_and_is_free_after_the_process():
    chosen = claimed(claimed(50))
    assert claimed(chosen) == chosen
