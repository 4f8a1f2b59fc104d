"""Runs a recorded program on floats, without a compiler."""

import math

from dynamics_node.codegen.trace import Symbol

_FUNCTIONS = {
    'add': lambda a, b: a + b,
    'subtract': lambda a, b: a - b,
    'multiply': lambda a, b: a * b,
    'divide': lambda a, b: a / b,
    'negate': lambda a: -a,
    'sin': math.sin,
    'cos': math.cos,
}


def run(program, results, **inputs):
    """Return the values of results for arrays of inputs."""
    values = {}

    def value(item):
        return values[item.index] if isinstance(item, Symbol) else item

    for index in program.needed(results):
        name, arguments = program.operations[index]
        if name == 'input':
            array, place = arguments
            values[index] = float(inputs[array][place])
        else:
            values[index] = _FUNCTIONS[name](*map(value, arguments))
    return [value(result) for result in results]
