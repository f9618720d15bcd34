"""Claims about R_min, convergence and torque: PROVED with their numbers, else UNDECIDED with a reason."""

from dataclasses import replace
from fractions import Fraction as F

import missions
import numpy as np
import pytest
from intermit.models.laws import QuaternionPD
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import filter_minimum, settling_time, simulate, torque_metrics
from intermit.verify.filter.answer import answer
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.worst_found import Search
from intermit.verify.verdict import Verdict
from problems import ADAPTIVE, J1, PERSISTENCE, REST, TILTED, paper_schedule

QUESTION = missions.question(
    law=PERSISTENCE,
    body=J1,
    schedule=paper_schedule(),
    max_angle_deg=F(120),
    max_weighted_rate=F("0.3"),
    options=FloorOptions(max_bins=4),
)


def by_key(found):
    return {claim.key: claim for claim in found.claims}


@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
def test_paper_scenario_is_proved_and_bounds_its_own_run(law):
    found = answer(missions.other(QUESTION, law=law, torque_limit=F(1000)))
    claims = by_key(found)
    assert {c.verdict for c in claims.values()} == {Verdict.PROVED}
    run = simulate(law, J1, QUESTION.mission.schedule, quaternion=TILTED, rate=REST, horizon=F(56))
    assert filter_minimum(run).value >= found.floor.value
    assert torque_metrics(run).peak[EUCLIDEAN].value <= found.torque.applied
    assert torque_metrics(run).peak_commanded[EUCLIDEAN].value <= found.torque.commanded
    assert settling_time(run, attitude=0.01, rate=0.01) <= found.convergence.settling


def test_torque_limit_below_the_bound_is_undecided():
    claim = by_key(answer(missions.other(QUESTION, torque_limit=F(5), run_peak=12.05)))["torque.limit"]
    assert claim.verdict is Verdict.UNDECIDED
    assert "exceeds the limit" in claim.reason
    assert "12.05 N m, exceeds it too" in claim.reason
    bound = next(q.high for q in claim.quantities if q.name == "torque_bound_applied")
    assert f"the bound is {bound / 12.05:.2g} times it" in claim.reason


def test_the_torque_of_the_search_stands_beside_the_bound():
    found = answer(
        missions.other(QUESTION, torque_limit=F(5), run_peak=0.5, search=Search(samples=16, rounds=0))
    )
    assert found.worst.peak[EUCLIDEAN] >= found.worst.peak[LARGEST_COMPONENT] > 0.5
    assert (
        f"of 16 runs over the set, {found.worst.peak[LARGEST_COMPONENT]:.4g} N m"
        in by_key(found)["torque.limit"].reason
    )


@pytest.mark.parametrize("decay", [F(100_000), F(10) ** 12])
def test_a_filter_that_forgets_within_a_gap_is_undecided(decay):
    """Partner: the paper's own lambda, whose exponent is 2.5, is proved above."""
    fast = missions.other(QUESTION, law=replace(PERSISTENCE, lambda_=decay), torque_limit=F(5))
    found = answer(fast)
    assert found.torque is None or not np.isnan(found.torque.applied)
    for claim in found.claims:
        assert claim.verdict is Verdict.UNDECIDED
        assert f"R decays by exp(-{4.79 * float(decay):.3g})" in claim.reason
        assert "lower lambda" in claim.next_step


@pytest.mark.parametrize(
    ("law", "words"), [(PERSISTENCE, "one over what is left"), (ADAPTIVE, "the gain k learns by it")]
)
def test_a_late_first_window_is_named_with_its_remedy(law, words):
    late = build_schedule([Window(F(1000), F(1003))], Hermite())
    claim = by_key(answer(missions.other(QUESTION, law=law, schedule=late)))["filter.floor"]
    assert claim.verdict is Verdict.UNDECIDED
    assert "until the first window opens R decays by exp(-525)" in claim.reason
    assert words in claim.reason
    assert "initial.time" in claim.next_step


def test_all_four_answers_about_the_floor_are_labelled():
    found = answer(missions.other(QUESTION, run_floor=(0.14947, 56.0), search=Search(samples=16, rounds=0)))
    quantities = {q.name: q for q in by_key(found)["filter.floor"].quantities}
    assert set(quantities) == {
        "certified_floor", "converged_floor", "floor_along_run", "worst_floor_found",
    }  # fmt: skip
    assert quantities["certified_floor"].high <= quantities["worst_floor_found"].low
    assert quantities["certified_floor"].high <= quantities["converged_floor"].low
    assert "to 24 s" in quantities["worst_floor_found"].label
    assert "to 56 s" in quantities["floor_along_run"].label
    assert [q.name for q in quantities.values() if q.rigorous] == ["certified_floor", "converged_floor"]


def test_a_lambda_below_the_sharp_condition_still_converges():
    """The condition on lambda is about V, not about the laws."""
    slow = replace(PERSISTENCE, lambda_=F("0.25"))  # sharp condition for J1: 0.341
    claim = by_key(answer(missions.other(QUESTION, law=slow)))["convergence"]
    assert claim.verdict is Verdict.PROVED


def test_finite_tables_bound_but_do_not_converge():
    windows = [Window(F(8 * k), F(8 * k) + F("3.2")) for k in range(3)]
    found = answer(missions.other(QUESTION, schedule=build_schedule(windows, Hermite())))
    claims = by_key(found)
    assert claims["filter.floor"].verdict is Verdict.PROVED
    assert "on [0, " in claims["filter.floor"].statement
    assert claims["convergence"].verdict is Verdict.UNDECIDED
    assert "finite" in claims["convergence"].reason


def test_a_set_too_wide_is_undecided_with_the_instant():
    found = answer(missions.other(QUESTION, law=ADAPTIVE, max_angle_deg=F(300), max_weighted_rate=F(2)))
    for claim in found.claims:
        assert claim.verdict is Verdict.UNDECIDED
        assert "reaches 2 pi at t = " in claim.reason
        assert claim.next_step


def test_a_law_outside_the_family_is_undecided():
    found = answer(missions.other(QUESTION, law=QuaternionPD(proportional=F(1), derivative=F(1))))
    for claim in found.claims:
        assert claim.verdict is Verdict.UNDECIDED
        assert "no comparison theorem covers law quaternion-pd" in claim.reason


def test_rate_bounds_of_the_set_become_weighted_ones():
    """|w| <= 0.1 with Jmax 3.113: |Omega|_J <= 0.1765 where the schedule starts closed."""
    slow = missions.other(QUESTION, max_weighted_rate=None, max_rate=F("0.1"))
    assert slow.initial.y_high == pytest.approx(0.1 * np.sqrt(J1.principal_inertias[-1]), rel=1e-9)
    assert missions.other(slow, max_rate=None).initial.y_high == 0.0
    both = missions.other(slow, max_weighted_rate=F("0.01"))
    assert both.initial.y_high == pytest.approx(0.01)


def test_an_inertia_tolerance_lowers_the_floor_or_leaves_it():
    wide = tuple(tuple(F("0.05") for _ in range(3)) for _ in range(3))
    exact, loose = answer(QUESTION), answer(missions.other(QUESTION, inertia_tolerance=wide))
    assert loose.floor.value < exact.floor.value
    assert by_key(loose)["filter.floor"].verdict is Verdict.PROVED


@pytest.mark.parametrize(("lead", "known"), [(20, True), (60, True), (200, False)])
def test_a_search_knows_r_however_small_until_it_is_forgotten(lead, known):
    """exp(-0.525 lead) is 2.8e-5, 2e-14 (beside an absolute tolerance of 1e-10) and 2.5e-46."""
    late = build_schedule([Window(F(lead), F(lead + 3))], Hermite())
    asked = missions.other(QUESTION, schedule=late)
    found = answer(replace(asked, search=Search(samples=8, rounds=0)))
    assert (found.worst is not None) == known
    if known:
        # the rise takes a moment to outweigh the decay
        assert 0.9 < found.worst.value / np.exp(-0.525 * lead) < 1
