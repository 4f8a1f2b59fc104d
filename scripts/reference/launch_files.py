"""Arguments of the launch files, read without running them."""

import ast
from dataclasses import dataclass


@dataclass(frozen=True)
class Argument:
    """A launch argument."""

    name: str
    words: str


def read(path):
    """
    Return the first paragraph of a launch file's docstring and its arguments.

    Parameters
    ----------
    path : Path

    Returns
    -------
    introduction : str
    arguments : list of Argument

    """
    tree = ast.parse(path.read_text(encoding='utf-8'))
    introduction = (ast.get_docstring(tree) or '').split('\n\n')[0].replace('\n', ' ')
    arguments = []
    for call in ast.walk(tree):
        if isinstance(call, ast.Call) and getattr(call.func, 'id', '') == 'DeclareLaunchArgument':
            words = {keyword.arg: keyword.value for keyword in call.keywords}
            arguments.append(
                Argument(ast.literal_eval(call.args[0]), ast.literal_eval(words['description']))
            )
    return introduction, arguments
