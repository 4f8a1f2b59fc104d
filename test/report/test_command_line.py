"""The command line of the report."""

from dynamics_node.report.__main__ import parse
import pytest


def test_defaults():
    options = parse(['a.urdf'])
    assert (options.robot, options.gravity, options.samples, options.seed) == (
        'a.urdf',
        (0.0, 0.0, -9.81),
        4096,
        1,
    )
    assert not (options.json or options.strict or options.html)


@pytest.mark.parametrize(
    'arguments',
    [
        [],
        ['a.urdf', '--gravity', '0', '0'],
        ['a.urdf', '--gravity', '0', '0', 'nan'],
        ['a.urdf', '--samples', 'many'],
        ['a.urdf', '--no-such-option'],
    ],
)
def test_unusable_arguments_end_with_2(arguments, capsys):
    with pytest.raises(SystemExit) as caught:
        parse(arguments)
    assert caught.value.code == 2
    assert 'usage: report' in capsys.readouterr().err


def test_negative_numbers_are_no_options():
    assert parse(['a.urdf', '--gravity', '-9.81', '0', '-0.001']).gravity == [-9.81, 0.0, -0.001]


def test_help_says_everything(capsys):
    with pytest.raises(SystemExit) as caught:
        parse(['--help'])
    text = capsys.readouterr().out
    assert caught.value.code == 0
    for words in (
        '--strict',
        '--json',
        '--html',
        'exit codes:',
        'xacro',
        '--payload-link',
        'm/s^2',
        'notes',
    ):
        assert words in text
    assert max(map(len, text.splitlines())) <= 99
