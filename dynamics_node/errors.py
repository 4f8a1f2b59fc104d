"""The exceptions of this package: one tree, each carrying its data; how they show a text."""

import difflib

_SHOWN = 60
# Comparing takes long for names that no robot has.
_LONGEST_COMPARED, _MOST_COMPARED = 100, 1000
# How like a name must be to be proposed, of 1.
_LIKENESS = 0.7


class DynamicsError(Exception):
    """Base of every error that this package raises on purpose."""


class RobotDescriptionError(DynamicsError, ValueError):
    """
    A robot description cannot be used; every problem found is listed.

    Attributes
    ----------
    problems : tuple of str
        One sentence per problem: name, expected, got.

    """

    def __init__(self, problems):
        self.problems = tuple(problems)
        count = len(self.problems)
        head = f'the robot description has {count} problem{"s" if count > 1 else ""}'
        super().__init__('\n  - '.join([f'{head}:', *self.problems]))


class ArgumentError(DynamicsError, ValueError):
    """An argument has the wrong shape, a value out of range or an unknown name."""


class InertiaError(DynamicsError, ValueError):
    """
    Inertial parameters belong to no real body.

    Attributes
    ----------
    violations : tuple of str
        One sentence per violated condition.

    """

    def __init__(self, violations):
        self.violations = tuple(violations)
        super().__init__('inertia is not physical: ' + '; '.join(self.violations))


class SingularMassMatrixError(DynamicsError, ArithmeticError):
    """The mass matrix is not positive definite, so accelerations are not defined."""


def quoted(text):
    """
    Return a text from outside as it may stand in an error message or a log.

    Parameters
    ----------
    text : str or None

    Returns
    -------
    str
        In quotes; line breaks and what cannot be printed as escapes, shortened if it is long.

    """
    text = str(text)
    return repr(text if len(text) <= _SHOWN else text[: _SHOWN - 3] + '...')


def suggestion(name, names):
    """
    Return which name was probably meant, to append to the sentence that refuses another one.

    Parameters
    ----------
    name : str
        The unknown name.
    names : collection of str
        The known ones.

    Returns
    -------
    str
        ", is 'elbow' meant?"; '' if none is similar.

    """
    if len(name) > _LONGEST_COMPARED or len(names) > _MOST_COMPARED:
        return ''
    similar = difflib.get_close_matches(name, names, n=1, cutoff=_LIKENESS)
    return f', is {quoted(similar[0])} meant?' if similar else ''
