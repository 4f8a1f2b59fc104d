"""ROS domains that no other test run on this machine uses."""

import os
import socket

# A domain is claimed by binding its port, as ROS's domain_coordinator does. The operating system
# frees the port at the end of the process.
FIRST_PORT = 32768
# Domains above 101 use ephemeral ports of Linux.
DOMAINS = 101
# Any step visits all domains, because 101 is prime.
STEP = 37


def claim():
    """
    Return a domain claimed until the end of this process.

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
            port.detach()  # stays bound, without a warning about an open socket
            return domain
    raise RuntimeError(
        f'expected a free ROS domain from 1 to {DOMAINS}, found none: end test '
        'runs that were left behind'
    )
