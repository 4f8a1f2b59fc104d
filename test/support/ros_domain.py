"""ROS domains that nothing else on this machine is in, as far as it says so."""

import os
import socket

# A domain is taken by binding its port, as ROS's own domain_coordinator does it. The operating
# system gives the port back when the process ends, however it ends.
FIRST_PORT = 32768
# Domains above 101 use ports that Linux also lends to others.
DOMAINS = 101
# Far from what a person would number by hand; any step visits all, 101 is prime.
STEP = 37


def claim():
    """
    Return a domain that is this process's own until it ends.

    The first choice is ROS_DOMAIN_ID. Each call returns another domain.

    """
    first = int(os.environ.get('ROS_DOMAIN_ID') or 1 + os.getpid() % DOMAINS)
    for domain in (first, *(1 + (first - 1 + STEP * k) % DOMAINS for k in range(1, DOMAINS + 1))):
        port = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        try:
            port.bind(('', FIRST_PORT + domain))
        except OSError:
            port.close()
        else:
            port.detach()  # stays bound, and nobody complains of a socket that is left open
            return domain
    raise RuntimeError(
        f'expected a free ROS domain from 1 to {DOMAINS}, found none: end test '
        'runs that were left behind'
    )
