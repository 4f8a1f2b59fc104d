"""docs/benchmarks.md, rendered from the results of one run."""

from . import tables
from .agreement import TOLERANCE
from .batch import LOOP_PART
from .formatting import digits
from .quantities import QUANTITIES
from .scaling import FITTED
from .single_call import PASSES, SLOW_ROUNDS
from .timing import SAMPLE_SECONDS, SLOW_CALL_SECONDS


def render(results, picture):
    """
    Return the report as Markdown.

    Parameters
    ----------
    results : Results
    picture : str
        Address of the plot, relative to the report.

    Returns
    -------
    str

    """
    parts = [_head(results, picture), *_single(results), *_batch(results), *_scaling(results)]
    for section in results.sections.values():
        parts += [f'## {section.title}', section.text, tables.section_table(section)]
    parts += _how(results)
    return '\n\n'.join(part for part in parts if part) + '\n'


def _head(results, picture):
    facts = tables.table(['measured on', ''], results.facts.items())
    libraries = tables.table(['library', 'version'], results.libraries.items())
    return '\n\n'.join(
        [
            '# Benchmarks',
            'Written by `make bench`, which measured every number on this page in one run of '
            f'{digits(results.seconds / 60)} minutes; do not edit by hand.',
            f'![Times of all libraries on logarithmic axes]({picture})',
            'A ratio is the time of a library divided by that of this one, `dynamics_node`: above '
            '1 this one is faster. It is the median over interleaved rounds, with the quartiles '
            'in brackets. Times are medians; on a shared machine they drift from table to table. '
            'Ratios drift much less, because they are taken within a round.',
            facts,
            libraries,
        ]
    )


def _single(results):
    joints = ', '.join(f'{name} ({count} joints)' for name, count in results.joints.items())
    parts = [
        '## One state at a time',
        f'Called from Python, on {joints}. All libraries get the same URDF text; the '
        'fingers of Panda and of arm7, the arm of this repository, are fixed: their mass '
        'stays. Before it is timed, every call must give the numbers of this library, up '
        f'to {TOLERANCE:g} of the largest element. The column *gives* names the results of each '
        'library.',
    ]
    for quantity, title in QUANTITIES.items():
        parts += [f'### {title[0].upper()}{title[1:]}', tables.single_table(results, quantity)]
    return parts


def _batch(results):
    parts = [
        '## Many states at once',
        f'D, C and G of {results.batch_count} states of the 7-joint arm. The loop over '
        f'Pinocchio runs through {100 * LOOP_PART:g} % of the states and is scaled; it '
        'copies its results into arrays, because the next call overwrites them. One core: every '
        'thread of the process is pinned to one.',
        tables.batch_table(results),
    ]
    if results.memory:
        parts.append(
            f'Memory of our call: the result has {_megabytes(results.memory["result"])}'
            f', the additional peak is {_megabytes(results.memory["besides"])}.'
        )
    return parts


def _scaling(results):
    return [
        '## Growth with the number of joints',
        'D, C and G of one state of generated robots, from the same URDF text for both. '
        f'The exponent is fitted to the {FITTED} largest sizes, round by round. A dense D '
        'and C alone have n² entries for any algorithm.',
        tables.scaling_table(results),
    ]


def _how(results):
    fewer = len(results.batch[0].seconds) if results.batch else 0
    parts = [
        '## How it is measured',
        f'In one process, garbage collector off, {results.rounds} rounds for single calls '
        f'and growth, {fewer} for batches. In each round every library gets its turn, in a '
        'changing order, for about '
        f'{1000 * SAMPLE_SECONDS:g} ms of calls through changing states. Single calls are '
        f'measured in {PASSES} passes over all robots and quantities; calls longer than '
        f'{1000 * SLOW_CALL_SECONDS:g} ms take part in the first {SLOW_ROUNDS} rounds of '
        'each. Models, data and everything else that a library can prepare are made '
        'before. The parts of a call:',
        tables.calls_table(results),
        '\n'.join(f'- **{name}**: {note}' for name, note in results.notes.items()),
    ]
    if results.single:
        worst = max(row.error for row in results.single)
        parts.append(
            "The largest difference between a library's result and ours in all of "
            f'these calls is {worst:.1e} of the largest element.'
        )
    if results.missing or results.refused:
        parts += [
            '## Not measured',
            '\n'.join(
                [
                    *(f'- {name}: {reason}' for name, reason in results.missing.items()),
                    *(f'- {sentence}' for sentence in results.refused),
                ]
            ),
        ]
    return parts


def _megabytes(size):
    return f'{digits(size / 1e6)} MB'
