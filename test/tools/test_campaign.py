"""Findings of a campaign, each with an input that reproduces it."""

import time
from types import SimpleNamespace

from fuzz import campaign
from fuzz.campaign import Campaign
from hypothesis import strategies as st
import pytest


def target(check):
    """Return a target for numbers."""
    return SimpleNamespace(
        NAME='a target',
        SUFFIX='.txt',
        check=check,
        warm_up=lambda: None,
        from_bytes=int,
        inputs=lambda: st.integers(0, 10**9).map(lambda number: [number]),
        to_bytes=lambda data: str(data).encode(),
    )


def run(check, folder, inputs=200, seed=7):
    """Return the result of a small campaign."""
    return Campaign(target(check), folder).run(inputs, seed)


def test_answers_are_counted_and_nothing_is_found(tmp_path):
    result = run(lambda data: ['even', 'number'] if data % 2 == 0 else ['odd', 'number'], tmp_path)
    assert result.inputs == result.answers['number'] == 200
    assert result.answers['even'] + result.answers['odd'] == 200
    assert result.findings == {}
    assert list(tmp_path.iterdir()) == []


def test_the_same_seed_draws_the_same_inputs(tmp_path):
    seen = []
    for seed in (7, 7, 8):
        seen.append([])
        run(lambda data: seen[-1].append(data) or [], tmp_path, seed=seed)
    assert seen[0] == seen[1] != seen[2]


def test_an_exception_is_a_finding_with_a_small_input(tmp_path):
    def check(data):
        if data > 999:
            raise KeyError('far too much')
        return ['small']

    result = run(check, tmp_path)
    [(where, finding)] = result.findings.items()
    assert where.startswith('test_campaign.py:')
    assert finding.error == "KeyError: 'far too much'"
    assert int(finding.path.read_text()) == 1000
    assert result.failures > 1


def test_a_warning_is_a_finding(tmp_path):
    import warnings

    def check(data):
        warnings.warn('overflow', RuntimeWarning, stacklevel=1)
        return []

    [finding] = run(check, tmp_path).findings.values()
    assert finding.error == 'RuntimeWarning: overflow'


def test_an_input_that_fails_only_sometimes_is_a_finding(tmp_path):
    calls = []

    def check(data):
        calls.append(data)
        if len(calls) == 50:
            raise KeyError('once')
        return []

    [finding] = run(check, tmp_path).findings.values()
    assert finding.error.startswith("KeyError: 'once' (Flaky")


def test_an_input_that_keeps_the_processor_is_a_finding(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, 'MAX_TIME', 0.01)

    def check(data):
        end = time.process_time() + (0.02 if data == 0 else 0.0)
        while time.process_time() < end:
            pass
        return []

    result = run(check, tmp_path)
    assert result.findings['slow'].path.read_text() == '0'
    assert result.slowest > 0.01


def test_an_input_that_never_ends_is_given_up(tmp_path, monkeypatch):
    monkeypatch.setattr(campaign, '_HANGS', 0.05)

    def check(data):
        while data == 0:
            pass
        return []

    result = run(check, tmp_path)
    assert result.findings['hangs'].path.read_text() == '0'
    assert result.answers['given up'] >= 1


@pytest.mark.parametrize('kept, is_finding', [(200_000, True), (0, False)])
def test_memory_that_grows_is_a_finding(tmp_path, monkeypatch, kept, is_finding):
    monkeypatch.setattr(campaign, 'MAX_GROWTH', 20.0)
    leak = []
    result = run(lambda data: leak.append(b'x' * kept) or [], tmp_path)
    # 180 of the inputs come after the first measurement: 36 MB.
    assert ('memory' in result.findings) == is_finding
    assert (result.late_memory - result.early_memory > 20.0) == is_finding
