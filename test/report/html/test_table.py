"""A table of the page."""

import math

from dynamics_node.report.html.table import amount, Cell, Column, name, table, words
import pytest


def test_a_table_has_a_heading_for_every_column_and_row():
    markup = table(
        'things',
        (Column('thing'), Column('mass', 'kg', True)),
        [(name('a_b'), amount(1.5)), (words('<c>'), amount(math.nan))],
    )
    assert markup.count('scope="col"') == 2 and markup.count('scope="row"') == 2
    assert '<td class="number" data-value="1.5">1.5</td>' in markup
    assert '&lt;c&gt;' in markup and '<c>' not in markup


def test_what_is_missing_is_sorted_as_missing_and_infinity_as_a_number():
    columns = (Column('x'), Column('y', is_number=True))
    assert 'class="number missing" data-value="">–' in table(
        't', columns, [(words('a'), amount(None))]
    )
    assert 'data-value="-Infinity">−∞' in table('t', columns, [(words('a'), amount(-math.inf))])


def test_a_row_of_another_length_is_refused():
    with pytest.raises(ValueError, match='shorter'):
        table('t', (Column('x'), Column('y')), [(Cell('a'),)])
