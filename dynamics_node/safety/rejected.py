"""What is said of a joint state that is not used."""

from ..errors import DynamicsError


class RejectedStateError(DynamicsError):
    """
    A joint state message was dropped.

    Attributes
    ----------
    kind : str
        Short and constant, for counting.
    is_fault : bool
        Whether the arm must not be driven any further.

    """

    def __init__(self, kind, message, is_fault=False):
        self.kind = kind
        self.is_fault = is_fault
        super().__init__(message)
