"""A browser is found where it should be, and missed aloud where one is required."""

import pytest

from .browser import browser, find_browser, require_browser


@pytest.fixture
def no_browser(monkeypatch, tmp_path):
    monkeypatch.setenv('PATH', str(tmp_path))
    for name in ('DYNAMICS_NODE_BROWSER', 'DYNAMICS_NODE_BROWSER_REQUIRED'):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.mark.parametrize('name', ['chromium', 'chromium-browser', 'google-chrome-stable'])
def test_a_browser_is_found_by_its_names(no_browser, name):
    program = no_browser / name
    program.write_text('#!/bin/sh\n')
    program.chmod(0o755)
    assert find_browser() == str(program)


def test_the_one_that_is_named_comes_first(no_browser, monkeypatch):
    for name in ('chromium', 'mine'):
        (no_browser / name).write_text('#!/bin/sh\n')
        (no_browser / name).chmod(0o755)
    monkeypatch.setenv('DYNAMICS_NODE_BROWSER', str(no_browser / 'mine'))
    assert require_browser() == str(no_browser / 'mine')


def test_without_one_tests_are_skipped_with_what_to_install(no_browser):
    with pytest.raises(pytest.skip.Exception, match='apt-get install chromium'):
        require_browser()


@pytest.mark.parametrize(
    'variable, value, match',
    [
        ('DYNAMICS_NODE_BROWSER_REQUIRED', '1', 'install chromium'),
        ('DYNAMICS_NODE_BROWSER', '/nowhere', "'/nowhere', which is no program"),
    ],
)
def test_where_one_is_required_or_named_tests_fail(
    no_browser, monkeypatch, variable, value, match
):
    monkeypatch.setenv(variable, value)
    with pytest.raises(pytest.fail.Exception, match=match):
        require_browser()


def test_a_program_that_is_no_browser_is_noticed(no_browser, monkeypatch):
    monkeypatch.setenv('PATH', '/usr/bin:/bin')
    monkeypatch.setenv('DYNAMICS_NODE_BROWSER', 'false')
    with pytest.raises((AssertionError, BrokenPipeError)), browser():
        pass
