"""A browser and its driver are found, and missed aloud if they are required."""

import pytest

from .browser import browser, find_browser, require_browser


def program(folder, name):
    """Write an executable file and return its path."""
    path = folder / name
    path.write_text('#!/bin/sh\n')
    path.chmod(0o755)
    return str(path)


@pytest.fixture
def no_browser(monkeypatch, tmp_path):
    """Return the only folder of the PATH, which is empty."""
    monkeypatch.setenv('PATH', str(tmp_path))
    for name in ('DYNAMICS_NODE_BROWSER', 'DYNAMICS_NODE_BROWSER_REQUIRED'):
        monkeypatch.delenv(name, raising=False)
    return tmp_path


@pytest.mark.parametrize('name', ['chromium', 'chromium-browser', 'google-chrome-stable'])
def test_a_browser_is_found_by_its_names(no_browser, name):
    assert program(no_browser, name) == find_browser()


def test_the_named_browser_comes_first(no_browser, monkeypatch):
    _, mine, driver = (program(no_browser, name) for name in ('chromium', 'mine', 'chromedriver'))
    monkeypatch.setenv('DYNAMICS_NODE_BROWSER', mine)
    assert require_browser() == (mine, driver)


@pytest.mark.parametrize(
    'present, missing', [([], 'no browser'), (['chromium'], 'no chromedriver')]
)
@pytest.mark.parametrize('outcome', [pytest.skip, pytest.fail])
def test_without_them_tests_are_skipped_or_fail_with_what_to_install(
    no_browser, monkeypatch, present, missing, outcome
):
    for name in present:
        program(no_browser, name)
    if outcome is pytest.fail:
        monkeypatch.setenv('DYNAMICS_NODE_BROWSER_REQUIRED', '1')
    with pytest.raises(outcome.Exception, match=f'{missing} .* install chromium chromium-driver'):
        require_browser()


def test_a_named_browser_that_is_no_program_fails(no_browser, monkeypatch):
    monkeypatch.setenv('DYNAMICS_NODE_BROWSER', '/nowhere')
    with pytest.raises(pytest.fail.Exception, match="'/nowhere', which is no program"):
        require_browser()


def test_a_program_that_is_no_browser_is_noticed(monkeypatch):
    selenium = pytest.importorskip('selenium.common.exceptions')
    require_browser()
    monkeypatch.setenv('DYNAMICS_NODE_BROWSER', 'false')
    with pytest.raises(selenium.WebDriverException), browser():
        pass
