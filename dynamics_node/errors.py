"""The exceptions of this package, in one tree, and helpers for their messages."""

from collections.abc import Collection, Iterable
import difflib

# Longest quoted text, characters.
_MAX_QUOTED = 60
# Longest name that is compared with known names, characters: longer ones take too long.
_MAX_COMPARED_LENGTH = 100
# Largest number of known names to compare with.
_MAX_COMPARED_NAMES = 1000
# Smallest similarity of a suggested name, from 0 to 1.
_MIN_SIMILARITY = 0.7


class DynamicsError(Exception):
    """Base class of every error that this package raises on purpose."""


class RobotDescriptionError(DynamicsError, ValueError):
    """
    A robot description cannot be used; the message lists every problem.

    Attributes
    ----------
    problems : tuple of str
        One sentence per problem: name, expected, got.

    """

    def __init__(self, problems: Iterable[str]) -> None:
        self.problems = tuple(problems)
        count = len(self.problems)
        head = f'the robot description has {count} problem{"s" if count > 1 else ""}'
        super().__init__('\n  - '.join([f'{head}:', *self.problems]))


class ArgumentError(DynamicsError, ValueError):
    """An argument has the wrong shape, a value out of range or an unknown name."""


class InertiaError(DynamicsError, ValueError):
    """
    Inertial parameters are physically impossible.

    Attributes
    ----------
    violations : tuple of str
        One sentence per violated condition.

    """

    def __init__(self, violations: Iterable[str]) -> None:
        self.violations = tuple(violations)
        super().__init__('inertia is not physical: ' + '; '.join(self.violations))


class SingularMassMatrixError(DynamicsError, ArithmeticError):
    """The mass matrix is not positive definite, so accelerations are not defined."""


class ParameterError(DynamicsError, ValueError):
    """A parameter value is refused: name, expected, got."""


class InvalidEffortError(DynamicsError):
    """An effort is not finite or has not one value per joint; it is never published."""


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

    def __init__(self, kind: str, message: str, is_fault: bool = False) -> None:
        self.kind = kind
        self.is_fault = is_fault
        super().__init__(message)


def quoted(text: str | None) -> str:
    """
    Return an untrusted text in a form that is safe in an error message or a log.

    Parameters
    ----------
    text : str or None

    Returns
    -------
    str
        In quotes; line breaks and unprintable characters as escapes; at most 60 characters.

    """
    text = str(text)
    return repr(text if len(text) <= _MAX_QUOTED else text[: _MAX_QUOTED - 3] + '...')


def suggestion(name: str, names: Collection[str]) -> str:
    """
    Return a similar known name, to append to the sentence that refuses an unknown one.

    Parameters
    ----------
    name : str
        The unknown name.
    names : collection of str
        The known names.

    Returns
    -------
    str
        ", is 'elbow' meant?"; '' if none is similar.

    """
    if len(name) > _MAX_COMPARED_LENGTH or len(names) > _MAX_COMPARED_NAMES:
        return ''
    similar = difflib.get_close_matches(name, names, n=1, cutoff=_MIN_SIMILARITY)
    return f', is {quoted(similar[0])} meant?' if similar else ''
