"""The progress bar."""

import os
import pty
import subprocess
import sys

from support.robots import ARM7


def test_it_is_on_standard_error_and_only_on_a_terminal():
    master, slave = pty.openpty()
    run = subprocess.Popen(
        [sys.executable, '-m', 'dynamics_node.report', str(ARM7)],
        stdout=subprocess.PIPE,
        stderr=slave,
        text=True,
        # Where a CI runs there may be none, or one that cannot go back.
        env={**os.environ, 'TERM': 'xterm'},
    )
    os.close(slave)
    shown = b''
    try:
        while part := os.read(master, 4096):
            shown += part
    except OSError:  # the other end is closed
        pass
    finally:
        os.close(master)
    out = run.communicate(timeout=120)[0]
    assert run.returncode == 0
    assert b'%' in shown and '\x1b' not in out and ' % ' not in out.split('Largest')[0]
