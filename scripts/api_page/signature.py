"""Signatures as they stand in the source: annotations as written, defaults as values."""

import ast
import enum
import inspect
import textwrap

_PLAIN = (bool, int, float, str, tuple, type(None))
_WIDTH = 99


def call(name, function, is_method=False):
    """
    Return how a function is called, with the types of its source.

    Parameters
    ----------
    name : str
        Written before the parentheses.
    function : callable
    is_method : bool
        Whether the first parameter is left out.

    Returns
    -------
    str
        On one line, or with one parameter per line if that is longer than a line of the source.

    """
    written = _annotations(function)
    parameters = list(inspect.signature(function).parameters.values())[is_method:]
    return _joined(name, parameters, written)


def constructor(kind):
    """
    Return how an object of a class is made, with the types of its source.

    Parameters
    ----------
    kind : type

    Returns
    -------
    str
        The name of the class alone if it is made without arguments, or not by users.

    """
    if not _has_arguments(kind):
        return kind.__name__
    own = vars(kind).get('__init__')
    written = _fields(kind) | (_annotations(own) if own else {})
    written.pop('return', None)
    return _joined(kind.__name__, list(inspect.signature(kind).parameters.values()), written)


def _has_arguments(kind):
    if issubclass(kind, enum.Enum):
        return False
    if issubclass(kind, BaseException) and '__init__' not in vars(kind):
        return False
    return bool(inspect.signature(kind).parameters)


def _joined(name, parameters, written):
    words, star = [], False
    for parameter in parameters:
        if parameter.kind is parameter.VAR_POSITIONAL:
            star = True
        if parameter.kind is parameter.KEYWORD_ONLY and not star:
            words.append('*')
            star = True
        words.append(_parameter(parameter, written.get(parameter.name)))
    returned = f' -> {written["return"]}' if 'return' in written else ''
    line = f'{name}({", ".join(words)}){returned}'
    if len(line) <= _WIDTH:
        return line
    return f'{name}(\n' + ''.join(f'    {word},\n' for word in words) + f'){returned}'


def annotation(function):
    """
    Return the annotation of what a function returns, as written; '' if there is none.

    Parameters
    ----------
    function : callable

    Returns
    -------
    str

    """
    return _annotations(function).get('return', '')


def _parameter(parameter, kind):
    prefix = {parameter.VAR_POSITIONAL: '*', parameter.VAR_KEYWORD: '**'}.get(parameter.kind, '')
    text = f'{prefix}{parameter.name}' + (f': {kind}' if kind else '')
    if parameter.default is parameter.empty:
        return text
    shown = repr(parameter.default) if isinstance(parameter.default, _PLAIN) else '...'
    return text + (f' = {shown}' if kind else f'={shown}')


def _fields(kind):
    """Return the annotations of the fields in the body of a class, in the words of its source."""
    body = ast.parse(textwrap.dedent(inspect.getsource(kind))).body[0].body
    return {
        node.target.id: ast.unparse(node.annotation)
        for node in body
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name)
    }


def _annotations(function):
    """Return the annotations of a function in the words of its source, by parameter."""
    try:
        source = textwrap.dedent(inspect.getsource(inspect.unwrap(function)))
    except (OSError, TypeError):  # made by dataclass, or by a compiler
        return {}
    node = ast.parse(source).body[0]
    if not isinstance(node, ast.FunctionDef | ast.AsyncFunctionDef):
        return {}
    arguments = node.args
    all_arguments = [*arguments.posonlyargs, *arguments.args, *arguments.kwonlyargs]
    all_arguments += [argument for argument in (arguments.vararg, arguments.kwarg) if argument]
    words = {
        argument.arg: ast.unparse(argument.annotation)
        for argument in all_arguments
        if argument.annotation
    }
    if node.returns:
        words['return'] = ast.unparse(node.returns)
    return words
