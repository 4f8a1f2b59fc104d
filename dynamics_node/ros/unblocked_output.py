"""Standard output and standard error that never block the process."""

import os
import threading

# Longest wait at the end for a terminal or a pipe that is not read, s.
CLOSE_WITHIN = 0.5


class UnblockedOutput:
    """
    Takes the place of a file descriptor; what it cannot pass on at once is dropped.

    A terminal that is paused by Ctrl-S, or a pipe whose reader has stopped, blocks the process in
    its next log line, and with it the arm.

    """

    def __init__(self, descriptor):
        """
        Replace a file descriptor by a pipe, which a thread empties into the original.

        Parameters
        ----------
        descriptor : int
            1 or 2.

        """
        self._descriptor = descriptor
        self._original = os.dup(descriptor)
        reader, writer = os.pipe()
        os.set_blocking(writer, False)
        os.dup2(writer, descriptor)
        os.close(writer)
        self._thread = threading.Thread(
            target=self._pass_on, args=(reader,), daemon=True, name=f'output {descriptor}'
        )
        self._thread.start()

    def close(self):
        """Put the original back, and give the thread a moment to pass on the rest."""
        os.dup2(self._original, self._descriptor)  # which closes the pipe's only way in
        self._thread.join(CLOSE_WITHIN)

    def _pass_on(self, reader):
        while data := os.read(reader, 65536):
            try:
                os.write(self._original, data)
            except OSError:  # the terminal is gone
                pass
