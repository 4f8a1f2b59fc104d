"""What the plots have in common."""

from dynamics_node.report.html_plot_parts import rows, short


def test_a_long_name_loses_its_middle():
    assert short('shoulder_pan_joint') == 'shoulder_pan_joint'
    cut = short('a' * 50 + 'b' * 50)
    assert len(cut) <= 26 and cut.startswith('aaa') and cut.endswith('bbb') and '…' in cut


def test_names_that_look_like_numbers_and_dates_stay_names():
    axis = rows(['1', '2026-01-01', '1'])
    assert axis['type'] == 'linear' and axis['tickvals'] == [0, 1, 2]
    assert axis['ticktext'] == ['1', '2026-01-01', '1']
