"""A margin is a value at which the certificate was found; beyond the true limit there is none."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction as F
from pathlib import Path

import pytest
from intermit.models.laws import Law
from intermit.models.schedule import Schedule, longer_gap
from intermit.scenario import load_scenario
from intermit.study.check.filter_question import floor_question, is_certified
from intermit.study.check.margins import convergence_margins
from intermit.study.simulated_run import RunFigures
from intermit.verify.exact.margin_search import greatest_certified, most_certified
from intermit.verify.schedule.zero_runs import longest_zero_run


@pytest.mark.parametrize("threshold", [F(1, 7), F(3), F(29, 10), F(1000)])
def test_search_ends_just_below_a_threshold(threshold: F) -> None:
    tried: list[F] = []

    def holds(x: F) -> bool:
        tried.append(x)
        return x <= threshold

    found = greatest_certified(holds, F(1, 2), limit=F(64), steps=6)
    assert found.evaluations == len(tried)
    assert found.certified <= min(threshold, F(64))
    assert found.certified == 0 or found.certified in tried
    if found.refused is None:
        assert found.certified == 64
    else:
        assert found.refused > threshold
        assert found.refused - found.certified <= max(found.certified, F(1, 2)) / 2**6


def test_search_believes_no_value_that_it_did_not_try() -> None:
    """A claim that holds nowhere but at 0 gives a margin of 0, not a guess."""
    assert greatest_certified(lambda _: False, F(1), limit=F(8)).certified == 0
    assert most_certified(lambda n: n <= 3, 8).certified == 3
    assert most_certified(lambda _: False, 8).certified == 0
    assert most_certified(lambda _: True, 8).refused is None


@pytest.mark.slow
def test_convergence_margins_hold_where_stated_and_flip_beyond(
    write_scenario: Callable[..., Path],
) -> None:
    scenario = load_scenario(write_scenario())
    (choice,) = scenario.laws
    question = floor_question(scenario, choice.build(), RunFigures(), search=False)
    calls: list[bool] = []

    def certified(law: Law, schedule: Schedule) -> bool:
        calls.append(is_certified(question, law, schedule))
        return calls[-1]

    margins = {q.name: q for q in convergence_margins(scenario, choice, certified)}
    run = longest_zero_run(scenario.schedule)
    assert run is not None
    longest = margins["longest_gap_certified"].low
    assert longest > float(run.length)
    at = longer_gap(scenario.schedule, run.on, F(longest) - run.length)
    assert is_certified(question, choice.build(), at)
    # With |Omega|_J up to 0.3 the angle can pass a full turn in a gap of 2 pi sqrt(Jmin) / 0.3 = 30.7 s
    # from rest at the target: no certificate exists there.
    beyond = longer_gap(scenario.schedule, run.on, F(40))
    assert not is_certified(question, choice.build(), beyond)
    assert longest < 31
    assert margins["least_lambda_certified"].high < 0.525
    assert {True, False} <= set(calls)
