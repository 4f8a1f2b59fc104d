"""The tables of the report, rendered from results."""

from .formatting import digits, ratio_text, time_text
from .quantities import QUANTITIES
from .scaling import exponent, SHAPES
from .timing import ratio_of, spread_of


def table(titles, rows):
    """
    Return a Markdown table.

    Parameters
    ----------
    titles : sequence of str
    rows : sequence of sequence of str

    Returns
    -------
    str

    """
    lines = ['| ' + ' | '.join(titles) + ' |', '|---' * len(titles) + '|']
    lines += [
        '| ' + ' | '.join(str(cell).replace('|', '\\|') for cell in row) + ' |' for row in rows
    ]
    return '\n'.join(lines)


def single_table(results, quantity):
    """
    Return the table of one quantity: a row per library, two columns per robot.

    Parameters
    ----------
    results : Results
    quantity : str
        A key of QUANTITIES.

    Returns
    -------
    str

    """
    rows = [row for row in results.single if row.quantity == quantity]
    robots = _unique(row.robot for row in rows)
    titles = ['library', 'gives', *(title for robot in robots for title in (robot, 'ratio'))]
    body = []
    for library in _unique(row.library for row in rows):
        cells = {row.robot: row for row in rows if row.library == library}
        first = next(iter(cells.values()))
        line = [
            library,
            ', '.join(first.parts).replace('qdd', 'q̈').replace('qd', 'q̇').replace('tau', 'τ'),
        ]
        for robot in robots:
            row = cells.get(robot)
            line += (
                ['–', '–']
                if row is None
                else [time_text(spread_of(row.seconds).median), _ratio(row.seconds, row.reference)]
            )
        body.append(line)
    return table(titles, body)


def calls_table(results):
    """
    Return the table of called functions by library and quantity.

    Parameters
    ----------
    results : Results

    Returns
    -------
    str

    """
    hows = {(row.library, row.quantity): row.how for row in results.single}
    return table(
        ['library', *QUANTITIES.values()],
        [
            [library, *(hows.get((library, quantity), '–') for quantity in QUANTITIES)]
            for library in _unique(row.library for row in results.single)
        ],
    )


def batch_table(results):
    """
    Return the table of the batch: a row per library and number of cores.

    Parameters
    ----------
    results : Results

    Returns
    -------
    str

    """
    body = []
    for row in results.batch:
        median = spread_of(row.seconds).median
        body.append(
            [
                row.library,
                row.how,
                row.cores,
                digits(spread_of(row.cores_used).median),
                time_text(median),
                time_text(median / results.batch_count),
                _ratio(row.seconds, row.reference['one']),
                _ratio(row.seconds, row.reference['all']),
            ]
        )
    return table(
        [
            'library',
            'how',
            'cores allowed',
            'cores busy',
            'all states',
            'per state',
            'ratio to ours on one core',
            'ratio to ours on all',
        ],
        body,
    )


def scaling_table(results):
    """
    Return the table of chains and trees, the fitted exponents in its last row.

    Parameters
    ----------
    results : Results

    Returns
    -------
    str

    """
    rows = {(row.joints, row.shape, row.library): row for row in results.scaling}
    libraries = _unique(row.library for row in results.scaling)
    titles, body = ['joints'], []
    for shape in SHAPES:
        titles += [f'{shape}: {library}' for library in libraries] + ['ratio']
    for joints in _unique(row.joints for row in results.scaling):
        line = [str(joints)]
        for shape in SHAPES:
            for library in libraries:
                row = rows.get((joints, shape, library))
                line.append('–' if row is None else time_text(spread_of(row.seconds).median))
            row = rows.get((joints, shape, libraries[-1]))
            line.append('–' if row is None else _ratio(row.seconds, row.reference))
        body.append(line)
    last = ['exponent']
    for shape in SHAPES:
        fits = [exponent(results.scaling, shape, library) for library in libraries]
        last += ['–' if fit is None else ratio_text(fit) for fit in fits] + ['–']
    return table(titles, [*body, last])


def section_table(section):
    """
    Return the table of a section measured by another file.

    Parameters
    ----------
    section : Section

    Returns
    -------
    str
        Empty if it has no rows.

    """
    if not section.rows:
        return ''
    titles = list(section.rows[0])
    return table(
        titles,
        [
            [
                row.get(title, '–') if isinstance(row.get(title), str) else digits(row[title])
                for title in titles
            ]
            for row in section.rows
        ],
    )


def _ratio(seconds, reference):
    return '1' if seconds == reference else ratio_text(ratio_of(seconds, reference))


def _unique(values):
    return list(dict.fromkeys(values))
