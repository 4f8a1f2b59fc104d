"""The benchmarks: a short run, and the report rendered from its results alone."""

from copy import deepcopy
import gc
from importlib import import_module
import re
import sys
from types import SimpleNamespace

import numpy as np
import pytest
from support.robots import ROBOTS

ROOT = ROBOTS.parents[1]
QUANTITIES = ('dynamics', 'mass_matrix', 'gravity', 'inverse', 'forward')
TITLES = [
    '### D, C and G',
    '### D',
    '### G',
    '### Inverse dynamics, q̈ → τ',
    '### Forward dynamics, τ → q̈',
]
SIZES = (2, 4, 8)
MODULES = (
    'agreement',
    'generated_robots',
    'scaling',
    'formatting',
    'plot',
    'report',
    'libraries',
    'robots',
    'run',
    'external_sections',
    'single_call',
    'tables',
    'timing',
    'libraries.pinocchio',
)


@pytest.fixture(scope='module')
def bench():
    # Only for the import: folders of the root, such as launch, would hide packages.
    sys.path.insert(0, str(ROOT))
    try:
        return SimpleNamespace(
            **{name.rpartition('.')[2]: import_module(f'benchmarks.{name}') for name in MODULES}
        )
    finally:
        sys.path.remove(str(ROOT))


@pytest.fixture(scope='module')
def results(bench):
    return bench.run.run(
        rounds=2,
        batch_count=500,
        sizes=SIZES,
        names=('pinocchio', 'mujoco'),
        with_sections=False,
        say=lambda text: None,
    )


def tables_of(report):
    """Return the tables below each heading, as lists of rows of cells."""
    sections: dict[str, list] = {}
    heading = ''
    for line in report.splitlines():
        if line.startswith('#'):
            heading = line
        elif line.startswith('|') and not line.startswith('|---'):
            sections.setdefault(heading, []).append(
                [cell.strip() for cell in line.strip('|').split('|')]
            )
    return sections


def test_every_library_is_measured_for_every_quantity_on_every_arm(results):
    measured = {(row.robot, row.quantity, row.library) for row in results.single}
    assert measured == {
        (robot, quantity, library)
        for robot in ('UR5', 'Panda', 'arm7')
        for quantity in QUANTITIES
        for library in ('dynamics_node', 'Pinocchio', 'MuJoCo')
    }
    assert results.refused == [] and results.missing == {}
    for row in results.single:
        assert len(row.seconds) == len(row.reference) == 2 and min(row.seconds) > 0.0
        assert row.error < 1e-10


def test_the_report_has_every_table_and_every_row(bench, results):
    tables = tables_of(bench.report.render(results, 'picture.png'))
    for title in TITLES:
        header, *rows = tables[title]
        assert header == ['library', 'gives', 'UR5', 'ratio', 'Panda', 'ratio', 'arm7', 'ratio']
        assert [row[0] for row in rows] == ['dynamics_node', 'Pinocchio', 'MuJoCo']
        assert '–' not in {cell for row in rows for cell in row}
    assert [row[0] for row in tables['## Many states at once'][1:]] == [
        'dynamics_node',
        'dynamics_node, fresh arrays',
        'dynamics_node',
        'dynamics_node, fresh arrays',
        'Pinocchio',
    ]
    assert [row[0] for row in tables['## Growth with the number of joints'][1:]] == [
        *map(str, SIZES),
        'exponent',
    ]
    facts = dict(row for row in tables['# Benchmarks'] if len(row) == 2)
    assert {'CPU', 'system', 'Python', 'commit', 'numpy', 'numba', 'Pinocchio', 'MuJoCo'} <= set(
        facts
    )
    assert all(facts[name] for name in facts if name != 'measured on')


def test_no_measured_number_is_typed_in(bench, results):
    # Other times must change every cell that is not a name, a number of joints or our own 1.
    changed = deepcopy(results)
    rng = np.random.default_rng(0)
    for row in (*changed.single, *changed.batch, *changed.scaling):
        row.seconds[:] = [value * rng.uniform(2.0, 3.0) for value in row.seconds]
    for row in (*changed.single, *changed.scaling):
        row.reference[:] = [value * rng.uniform(5.0, 6.0) for value in row.reference]
    for row in changed.batch:
        for values in row.reference.values():
            values[:] = [value * rng.uniform(5.0, 6.0) for value in values]
        row.cores_used[:] = [value * 1.5 for value in row.cores_used]
    changed.memory = {
        'result': 17 * results.memory['result'],
        'besides': 17 * results.memory['besides'] + 12345678,
    }
    before = tables_of(bench.report.render(results, 'picture.png'))
    after = tables_of(bench.report.render(changed, 'picture.png'))
    measured = [*TITLES, '## Many states at once', '## Growth with the number of joints']
    count = 0
    for title in measured:
        for old, new in zip(before[title][1:], after[title][1:], strict=True):
            for heading, *cells in zip(before[title][0], old, new, strict=True):
                if heading in ('library', 'gives', 'how', 'cores allowed', 'joints'):
                    continue
                if cells[0] in ('1', '–'):
                    continue
                assert cells[0] != cells[1], (title, heading, cells)
                count += 1
    assert count > 60
    sentence = re.compile(r'Memory of our call:.*')
    assert (
        sentence.search(bench.report.render(results, ''))[0]
        != sentence.search(bench.report.render(changed, ''))[0]
    )


def test_the_plot_is_drawn(bench, results, tmp_path):
    bench.plot.draw(results, tmp_path / 'plot.png')
    assert (tmp_path / 'plot.png').read_bytes().startswith(b'\x89PNG')


def test_a_library_with_other_numbers_is_refused_and_not_timed(bench):
    robot = bench.robots.arm7()
    honest = bench.pinocchio.calls(robot)['gravity']

    def wrong(q):
        return (honest.run(q)[0] * (1.0 + 1e-7),)

    call = type(honest)(wrong, ('G',), 'wrong')
    wrong_library = SimpleNamespace(NAME='wrong', calls=lambda robot: {'gravity': call})
    rows, refused = bench.single_call.measure(
        [robot], {'wrong': wrong_library}, 1, lambda text: None
    )
    assert {row.library for row in rows} == {'dynamics_node'}
    [sentence] = refused
    assert re.fullmatch(
        'wrong, arm7, G: G: expected a difference of at most 1e-08 of the '
        'largest element, got 1e-07',
        sentence,
    )


def test_not_a_number_is_refused(bench):
    robot = bench.robots.arm7()
    nan = bench.pinocchio.calls(robot)['gravity'].__class__(
        lambda q: (np.full(7, np.nan),), ('G',), 'nan'
    )
    with pytest.raises(bench.agreement.DifferentResultError, match='got nan'):
        bench.agreement.check(robot, 'gravity', nan)


def test_a_library_that_is_not_installed_is_named_with_the_reason(bench, monkeypatch):
    monkeypatch.setitem(sys.modules, 'pydrake.multibody.parsing', None)
    monkeypatch.setitem(sys.modules, 'pydrake', None)
    monkeypatch.delitem(sys.modules, 'benchmarks.libraries.drake', raising=False)
    loaded, missing = bench.libraries.load(('drake',))
    assert loaded == {} and 'pydrake' in missing['drake']


def test_sections_of_other_files(bench, monkeypatch, tmp_path):
    (tmp_path / 'good_section.py').write_text(
        '"""How it was measured."""\n\n\ndef measure():\n'
        '    return [{"what": "round trip", "ms": 0.51234}]\n'
    )
    (tmp_path / 'bad_section.py').write_text('def measure():\n    raise OSError("no network")\n')
    package = sys.modules['benchmarks']
    monkeypatch.setattr(package, '__path__', [*package.__path__, str(tmp_path)])
    monkeypatch.setattr(
        bench.external_sections,
        'SECTIONS',
        {
            'good': ('Good', 'good_section'),
            'bad': ('Bad', 'bad_section'),
            'none': ('None', 'no_section'),
        },
    )
    sections = bench.external_sections.measure(say=lambda text: None)
    assert sections['good'].text == 'How it was measured.'
    assert bench.tables.section_table(sections['good']).splitlines() == [
        '| what | ms |',
        '|---|---|',
        '| round trip | 0.512 |',
    ]
    assert sections['bad'].text == 'Not measured: OSError: no network'
    assert sections['none'].text == 'Not measured: there is no benchmarks/no_section.py.'
    for name in ('good_section', 'bad_section'):
        monkeypatch.delitem(sys.modules, f'benchmarks.{name}')


def test_a_section_measured_alone_replaces_the_old_one(bench):
    report = '# Benchmarks\n\n## The node\n\nold\n\n| a |\n|---|\n| 1 |\n\n## How\n\ntext\n'
    section = bench.external_sections.Section(
        'The node', r'new \1', [{'what': 'p50', 'ratio': '1.1'}]
    )
    new = bench.external_sections.replace(
        report, section, {'CPU': 'a processor', 'Python': '3.12'}
    )
    assert new.startswith('# Benchmarks\n\n## The node\n\nnew \\1\n\n')
    assert new.endswith('\n\n## How\n\ntext\n')
    assert 'CPU a processor; Python 3.12.' in new
    assert '| p50 | 1.1 |' in new and 'old' not in new
    with pytest.raises(ValueError, match='expected a section "Other"'):
        bench.external_sections.replace(report, bench.external_sections.Section('Other', ''), {})


def test_ratios_are_those_of_the_same_round(bench):
    spread = bench.timing.ratio_of([2.0, 40.0, 600.0], [1.0, 10.0, 100.0, 7.0])
    assert (spread.median, spread.low, spread.high) == (4.0, 3.0, 5.0)


def test_rounds_are_interleaved_and_begin_with_another_candidate(bench, monkeypatch):
    order = []
    monkeypatch.setattr(
        bench.timing, 'time_of', lambda function, arguments, count: order.append(function()) or 1.0
    )
    samples = bench.timing.interleaved(
        {name: ((lambda *_, name=name: name), [()]) for name in 'ab'}, rounds=7, slow_rounds=3
    )
    # One call each to see how long it takes, then rounds; a call of 1 s is a slow one.
    assert ''.join(order) == 'ab' + 'ab' + 'ba' + 'ab'
    assert samples == {'a': [1.0] * 3, 'b': [1.0] * 3}


def test_a_slow_library_is_compared_in_the_same_rounds(bench, monkeypatch):
    # Our 7 rounds are 3 + 2 + 2; a slow one takes part in the first 2 of each pass.
    turns = iter((3, 2, 2))
    clock = iter(range(7))

    def measured(candidates, rounds, slow_rounds):
        assert rounds == next(turns)
        mine = [float(next(clock)) for _ in range(rounds)]
        return {
            name: mine if name == 'dynamics_node' else mine[:slow_rounds] for name in candidates
        }

    monkeypatch.setattr(bench.single_call, 'interleaved', measured)
    monkeypatch.setattr(bench.single_call, 'QUANTITIES', {'gravity': 'G'})
    rows, _ = bench.single_call.measure(
        [bench.robots.arm7()], {'pinocchio': bench.pinocchio}, 7, say=lambda text: None
    )
    assert [row.seconds for row in rows] == [[0, 1, 2, 3, 4, 5, 6], [0, 1, 3, 4, 5, 6]]
    assert rows[1].reference == rows[1].seconds


def test_the_collector_is_off_while_the_clock_runs(bench):
    seen = []
    bench.timing.interleaved({'a': (lambda: seen.append(gc.isenabled()), [()])}, rounds=1)
    assert seen and not any(seen) and gc.isenabled()


def test_the_exponent_is_the_slope_of_a_power_law(bench):
    # Rounds of different speed, the last one disturbed: the median is that of the power law.
    rows = [
        bench.scaling.ScalingRow(
            'chain', joints, 'x', [1e-6 * joints**1.5, 3e-6 * joints**1.5, 1e-6 * joints**2.5], []
        )
        for joints in (2, 4, 8, 16)
    ]
    spread = bench.scaling.exponent(rows, 'chain', 'x')
    assert (spread.median, spread.low, spread.high) == pytest.approx((1.5, 1.5, 2.0))
    assert bench.scaling.exponent(rows[:1], 'chain', 'x') is None


@pytest.mark.parametrize('shape, depth', [('chain', 31), ('binary_tree', 5)])
def test_generated_robots_have_the_shape_that_they_are_named_after(bench, shape, depth):
    robot = bench.robots.make_robot(shape, getattr(bench.generated_robots, shape)(31))
    parent = robot.model.tree.parent
    levels = np.zeros(31, dtype=int)
    for k in range(31):
        levels[k] = levels[parent[k]] + 1 if parent[k] >= 0 else 1
    assert levels.max() == depth
    # Pinocchio counts the joints in the same order, or this raises.
    bench.pinocchio.model_of(robot)


@pytest.mark.parametrize(
    'seconds, text',
    [
        (1.234e-6, '1.23 µs'),
        (0.00012345, '123 µs'),
        (2.0, '2 s'),
        (0.5, '500 ms'),
        (3.21e-10, '0.321 ns'),
        (1234.0, '1230 s'),
    ],
)
def test_times_have_three_digits_and_a_unit(bench, seconds, text):
    assert bench.formatting.time_text(seconds) == text
