"""One run of all measurements, in this process unless a library needs another Python."""

from dataclasses import replace
from time import perf_counter

from . import batch, external_sections, host, libraries, memory, scaling, single_call
from .libraries import dynamics_node
from .other_interpreter import KDL_PYTHON, measure_elsewhere
from .results import Results
from .robots import arms


def run(
    rounds,
    batch_count,
    sizes=scaling.SIZES,
    names=libraries.FILES,
    kdl_python=KDL_PYTHON,
    with_sections=True,
    say=print,
):
    """
    Run all measurements.

    Parameters
    ----------
    rounds : int
        Interleaved rounds of single calls; the batch takes a third of them, at least 3.
    batch_count : int
        States in a batch.
    sizes : sequence of int
        Numbers of joints of the generated robots.
    names : sequence of str
        Files in `libraries/`.
    kdl_python : pathlib.Path
        An interpreter with PyKDL, used if this one lacks it.
    with_sections : bool
        Whether to measure the sections of other files.
    say : callable
        Prints the progress.

    Returns
    -------
    Results

    """
    begin = perf_counter()
    results = Results(host.describe(), rounds=rounds, batch_count=batch_count)
    loaded, missing = libraries.load(names)
    for module in (dynamics_node, *loaded.values()):
        version = getattr(module, 'VERSION', None) or libraries.version_of(module.PACKAGE)
        results.libraries[module.NAME] = version or 'version unknown'
        results.notes[module.NAME] = module.NOTE
    if 'frax' in loaded:
        results.facts['JAX'] = libraries.version_of('jax') or 'version unknown'
    robots = arms()
    results.joints = {robot.name: robot.n for robot in robots}
    fewer = max(3, rounds // 3)
    results.single, results.refused = single_call.measure(robots, loaded, rounds, say)
    if 'kdl' in missing and kdl_python.exists():
        _add_kdl(results, missing, kdl_python, robots, rounds, say)
    results.missing = missing
    results.batch, refused = batch.measure(robots[-1], batch_count, loaded, fewer, say)
    results.refused += refused
    results.memory = memory.peak_besides_result(batch_count)
    results.scaling, refused = scaling.measure(loaded, rounds, sizes, say)
    results.refused += refused
    if with_sections:
        results.sections = external_sections.measure(say)
    results.seconds = perf_counter() - begin
    return results


def _add_kdl(results, missing, python, robots, rounds, say):
    say('single calls: PyKDL, in a process of its own')
    try:
        result = measure_elsewhere('kdl', python, robots, rounds)
    except RuntimeError as error:
        missing['kdl'] = str(error)
        return
    del missing['kdl']
    name = result['name']
    results.libraries[name] = result['version']
    results.notes[name] = (
        f'{result["note"]} Debian builds it for its own Python only, so it ran in a separate '
        f'process (Python {result["python"]}, numpy {result["numpy"]}) together with this '
        'library: its ratio comes from that process.'
    )
    label = f'{name} (own process)'
    results.single += [
        replace(row, library=label) for row in result['rows'] if row.library == name
    ]
    results.refused += result['refused']
