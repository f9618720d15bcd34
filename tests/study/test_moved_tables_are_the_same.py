"""Thirty random tables moved by up to 56 years: the same verdicts, figures and transfers but for times."""

from dataclasses import replace
from decimal import Decimal
from fractions import Fraction as F
from types import SimpleNamespace

import numpy as np
import pytest
from intermit.models.norms import NORMS
from intermit.optim.comparison.equal_terms import problem_of
from intermit.optim.comparison.measure import Goal
from intermit.optim.problem import WindowProfile
from intermit.scenario import load_scenario
from intermit.study.check.record import check_record
from intermit.study.check.run import CheckOptions, run_check
from intermit.study.optimum.run import run_optimum, transfer
from intermit.study.simulated_run import metrics, run_law

SHIFTS = (10**3, 10**6, 1_760_000_000)
SCENARIO = """
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
[schedule]
windows = [{windows}]
{period}
[initial]
time = {start}
axis = [1, 2, 3]
angle_deg = {angle}
[[law]]
{law}
[simulation]
horizon = {horizon}
[check]
samples = 256
[optimum]
final_time = {horizon}
starts = 1
"""
PD = 'type = "quaternion-pd"\nproportional = 0.4\nderivative = 1.5'
FILTER = 'type = "persistence-filter"\nlambda = 0.4\nR0 = 1'


def table(seed):
    """Windows in milliseconds, and the period for an odd seed."""
    rng = np.random.default_rng(seed)
    at, windows = int(rng.integers(0, 3000)), []
    for _ in range(int(rng.integers(1, 5))):
        length = int(rng.integers(20, 4000))
        windows.append((at, at + length))
        at += length + int(rng.integers(100, 5000))
    return windows, at if seed % 2 else None


def seconds(ms):
    return str(Decimal(ms).scaleb(-3))


def moved(folder, seed, shift, *, start=None, law=PD):
    """The table moved by `shift` s; the run starts with it, or where `start` says."""
    windows, period = table(seed)
    move = 1000 * shift
    path = folder / f"{seed}-{shift}.toml"
    path.write_text(
        SCENARIO.format(
            windows=", ".join(f"[{seconds(a + move)}, {seconds(b + move)}]" for a, b in windows),
            period="" if period is None else f"period = {seconds(period)}",
            start=shift if start is None else start,
            angle=20 + 5 * seed,
            horizon=seconds((2 * period if period is not None else windows[-1][1] + 2000) + move),
            law=law,
        )
    )
    return load_scenario(path)


def figures(scenario):
    run = run_law(scenario, scenario.laws[0].build())
    assert run.failure == ""
    return run, {m.name: m.low for m in metrics(run)}


@pytest.mark.parametrize("seed", range(30))
def test_a_table_moved_with_its_start_is_the_same_scenario(tmp_path, seed):
    still = moved(tmp_path, seed, 0)
    for shift in SHIFTS:
        other = moved(tmp_path, seed, shift)
        assert other.schedule == still.schedule
        names = {"path", "text", "clock", "sha256", "name", "schedule_choice", "laws"}
        same = {name: getattr(still, name) for name in names}
        assert replace(other, **same) == still
        assert not other.warnings


@pytest.mark.parametrize("seed", range(0, 30, 2))
def test_a_table_far_behind_a_start_at_rest_is_the_same(tmp_path, seed):
    still = moved(tmp_path, seed, 0, start=0)
    first = still.schedule.windows[0].on
    _, known = figures(still)
    for shift in SHIFTS:
        far = moved(tmp_path, seed, shift, start=0)
        run, found = figures(far)
        assert run.origin == first + shift
        known["settling_time"] = found["settling_time"]  # a time: it moves; drifts are rounding
        drifts = {"quaternion_norm_drift", "free_momentum_drift"}
        for name in known.keys() - drifts - {"settling_time"}:
            assert found[name] == pytest.approx(known[name], rel=1e-9, abs=1e-12), name
        problems = [transfer(s, NORMS["component"]) for s in (still, far)]
        assert problems[1].open_pieces == tuple(
            replace(p, start=p.start - first, end=p.end - first) for p in problems[0].open_pieces
        )


def record_of(scenario):
    """The check's record without what names the file, its text and its clock."""
    record = check_record(run_check(scenario, CheckOptions(margins=False, search=False)))
    known = record.sections.scenario
    facts = tuple(fact for fact in known.facts if fact.label != "clock")
    sections = record.sections.but(scenario=known.but(facts=facts, name=""))
    text = repr(sections).replace(scenario.path.name, "FILE").replace(scenario.path.stem, "FILE")
    return text, {name: np.asarray(values) for name, values in record.arrays.items()}, record.outcome


@pytest.mark.parametrize(("seed", "law"), [(4, PD), (7, FILTER)])
def test_the_record_is_the_same_but_for_the_clock(tmp_path, seed, law):
    text, arrays, outcome = record_of(moved(tmp_path, seed, 0, law=law))
    other = record_of(moved(tmp_path, seed, SHIFTS[-1], law=law))
    assert (other[0], other[2]) == (text, outcome)
    assert other[1].keys() == arrays.keys()
    for name, values in arrays.items():
        assert np.array_equal(other[1][name], values, equal_nan=True), name


@pytest.mark.soak
@pytest.mark.parametrize("law", [PD, FILTER])
@pytest.mark.parametrize("seed", range(30))
def test_verdicts_and_optima_are_the_same(tmp_path, seed, law):
    text, _, outcome = record_of(moved(tmp_path, seed, 0, law=law))
    peaks = [o.answer.peak for o in run_optimum(moved(tmp_path, seed, 0, law=law)).optima]
    for shift in SHIFTS:
        other = moved(tmp_path, seed, shift, law=law)
        assert record_of(other)[::2] == (text, outcome)
        assert [o.answer.peak for o in run_optimum(other).optima] == peaks


@pytest.mark.parametrize("shift", SHIFTS)
def test_a_comparison_leaves_the_idle_lead_out(tmp_path, shift):
    problems = []
    for move in (100, shift):
        far = moved(tmp_path, 2, move, start=0)
        goal = Goal(far.horizon, F(1, 100), F(1, 100))
        run = SimpleNamespace(mission=far.mission)
        problems.append(problem_of(run, NORMS["euclidean"], goal, WindowProfile.FULL))
    assert problems[0].window == problems[1].window
    assert problems[0].window.knots[-1] < 50


def test_a_table_moved_without_its_start_is_another_scenario(tmp_path):
    """The partner: with the start left behind, a filter law's run differs, and says why."""
    far = moved(tmp_path, 6, 1000, start=0, law=FILTER)
    assert far.schedule != moved(tmp_path, 6, 0, law=FILTER).schedule
    assert "initial.time" in run_law(far, far.laws[0].build()).failure
    assert F(1000) < far.schedule.windows[0].on
