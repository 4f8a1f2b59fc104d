"""docs/api.md: up to date, complete, and each of its names has a docstring."""

import enum
from pathlib import Path
import subprocess
import sys

import dynamics_node
import pytest

ROOT = Path(__file__).parents[1]
sys.path.insert(0, str(ROOT / 'scripts'))

from api_page import docstring, members, page, signature  # noqa: E402

NAMES = [
    *members.library_names(),
    *(name for folder in members.PACKAGES for name in members.package_names(folder)),
]


def test_it_is_up_to_date():
    assert page.PATH.read_text() == page.render(), 'run python scripts/write_api.py'


def test_every_public_name_is_on_it():
    text = page.PATH.read_text()
    for name in dynamics_node.__all__:
        assert name.startswith('_') or f'\n### {name}\n' in text, name


@pytest.mark.parametrize('entry', NAMES, ids=lambda entry: f'{entry.package}.{entry.name}')
def test_every_name_and_member_has_a_docstring(entry):
    assert docstring.summary(entry.value.__doc__)
    if isinstance(entry.value, type) and not issubclass(entry.value, enum.Enum):
        for group in members.public_members(entry.value):
            for name, value in group.items():
                assert docstring.summary(value.__doc__), f'{entry.name}.{name}'


def test_its_packages_work_without_ros():
    packages = ', '.join(f'dynamics_node.{folder}' for folder in members.PACKAGES)
    code = f'import sys\nimport {packages}\nassert "rclpy" not in sys.modules'
    subprocess.run([sys.executable, '-c', code], cwd=ROOT, check=True, timeout=120)


def test_a_docstring_becomes_markdown():
    text = docstring.to_markdown(
        """
        Return the `mass` of <inertial>, 2 * m.

            T = 1/2 m v^2

        Parameters
        ----------
        q : array_like, shape (n,)
            Position,
            rad.

        Raises
        ------
        ArgumentError
            If it is wrong.

        """
    )
    assert text.split('\n\n') == [
        r'Return the `mass` of \<inertial>, 2 \* m.',
        '```text\nT = 1/2 m v^2\n```',
        '**Parameters**',
        '- `q`: array_like, shape (n,) — Position, rad.',
        '**Raises**',
        '- `ArgumentError` — If it is wrong.',
    ]


def test_a_signature_has_the_types_as_they_are_written():
    def function(q: 'float', *, mass: float = 1.0, name=None) -> float:
        return q * mass

    assert (
        signature.call('f', function) == "f(q: 'float', *, mass: float = 1.0, name=None) -> float"
    )
    assert signature.annotation(function) == 'float'
