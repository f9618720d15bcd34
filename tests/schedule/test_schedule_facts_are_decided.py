"""Each fact of a schedule is proved where it holds and refuted where one thing is broken."""

from dataclasses import replace
from fractions import Fraction

import pytest
from intermit.models.schedule import Hermite, PiecewisePolynomial, Ramps, Schedule, Window, build_schedule
from intermit.models.schedule.polynomial import polynomial
from intermit.verify.schedule.facts import schedule_claims
from intermit.verify.verdict import Verdict

F = Fraction
EIGHT = F(8)
RISE = F("0.01")


def paper(overrun="0", period=EIGHT):
    window = Window(F("0.01"), F("3.21"))
    return build_schedule(
        [window], Hermite(F(overrun)), period=period, thruster_rise=RISE, thruster_fall=RISE
    )


def verdicts(schedule, **options):
    return {claim.key: claim for claim in schedule_claims(schedule, **options)}


@pytest.mark.parametrize("period", [None, F(8)])
def test_everything_holds_for_the_corrected_paper(period):
    claims = verdicts(paper(period=period))
    assert len(claims) == 4
    assert all(claim.verdict is Verdict.PROVED and claim.counted for claim in claims.values())


def test_overrun_is_refuted_and_counted_unless_asked_for():
    for asked in (False, True):
        claims = verdicts(paper("0.01"), overruns_as_printed=asked)
        for key in ("schedule.support", "schedule.uncertain-thrust"):
            claim = claims[key]
            assert claim.verdict is Verdict.REFUTED
            assert claim.counted is not asked
            assert claim.witness.values["from"] == 3.21
            assert claim.witness.values["to"] == 3.22
            assert 3.21 < claim.witness.values["time"] < 3.22
            assert claim.witness.violation.low > 0
            assert any("E9" in e.summary for e in claim.evidence) is asked


def test_asking_for_the_overrun_excuses_nothing_else():
    """An overrun longer than thruster_fall, and g acting in the rise, count however g was asked for."""
    longer = paper("0.02")
    assert verdicts(longer, overruns_as_printed=True)["schedule.support"].counted
    early = replace(paper("0.01"), windows=(Window(F("0.02"), F("3.21")),))
    claims = verdicts(early, overruns_as_printed=True)
    assert claims["schedule.support"].counted
    assert claims["schedule.support"].witness.values["from"] == 0.01


def test_no_claim_about_rise_and_fall_unless_given():
    schedule = replace(paper(), thruster_rise=F(0), thruster_fall=F(0))
    assert set(verdicts(schedule)) == {"schedule.order", "schedule.smooth", "schedule.support"}


def test_rise_reaching_into_the_window_before_is_refuted():
    windows = [Window(F(1), F(2)), Window(F("2.5"), F(3))]
    sound = build_schedule(windows, Hermite(), thruster_rise=F("0.5"))
    assert verdicts(sound)["schedule.uncertain-thrust"].verdict is Verdict.PROVED
    claim = verdicts(replace(sound, thruster_rise=F("0.6")))["schedule.uncertain-thrust"]
    assert claim.verdict is Verdict.REFUTED
    assert 1.9 < claim.witness.values["time"] < 2


def test_rise_wraps_round_the_period():
    """The rise before a window at 0 s lies at the end of the period before; in a finite table before 0 s."""
    windows = [Window(F(0), F(1)), Window(F("3.8"), F("3.95"))]
    sound = build_schedule(windows, Hermite(), period=F(4), thruster_rise=F("0.05"))
    assert verdicts(sound)["schedule.uncertain-thrust"].verdict is Verdict.PROVED
    claim = verdicts(replace(sound, thruster_rise=F("0.1")))["schedule.uncertain-thrust"]
    assert claim.verdict is Verdict.REFUTED
    assert 3.9 < claim.witness.values["time"] < 3.95
    finite = build_schedule(windows, Hermite(), thruster_rise=F("0.1"))
    assert verdicts(finite)["schedule.uncertain-thrust"].verdict is Verdict.PROVED


def test_overlap_and_empty_windows_are_refuted():
    for windows, time in (
        ((Window(F(0), F(2)), Window(F(1), F(3))), 1),
        ((Window(F(0), F(2)), Window(F(3), F(3))), 3),
        ((Window(F(2), F(1)),), 1),
    ):
        profile = PiecewisePolynomial((F(0), F(8)), (polynomial(),))
        claim = verdicts(Schedule(windows, profile))["schedule.order"]
        assert claim.verdict is Verdict.REFUTED
        assert claim.witness.values["time"] == time


def test_last_window_of_a_period_against_the_first_of_the_next():
    profile = PiecewisePolynomial((F(0), F(8)), (polynomial(),))
    schedule = Schedule((Window(F(1), F(2)), Window(F(5), F(10))), profile, period=F(8))
    claim = verdicts(schedule)["schedule.order"]
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness.violation.low == 1.0


def broken(i, shape):
    schedule = paper()
    shapes = list(schedule.profile.shapes)
    shapes[i] = shape
    return replace(schedule, profile=PiecewisePolynomial(schedule.profile.knots, tuple(shapes)))


@pytest.mark.parametrize(
    ("i", "shape", "what", "time"),
    [
        (1, polynomial(0, 1), "dg/dt", 0.01),  # a straight ramp has a corner where it starts
        (1, polynomial(F(1, 10**30), 0, 3, -2), "g", 0.01),  # a step of 1e-30 is a step
        (2, polynomial(F(99, 100)), "g", 0.81),
        (3, polynomial(1, 0, -2, 1), "dg/dt", 3.21),
        (4, polynomial(0, 0, 1), "g", 8.0),  # at the period's end
    ],
)
def test_a_jump_is_found_where_it_is(i, shape, what, time):
    claim = verdicts(broken(i, shape))["schedule.smooth"]
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness.description.startswith(f"{what} jumps")
    assert claim.witness.values["time"] == time


def test_a_finite_table_ends_at_zero_but_a_period_need_not():
    """g = 1 throughout is C1 if it repeats for ever, and jumps at the end of a finite table."""
    profile = PiecewisePolynomial((F(0), F(4)), (polynomial(1),))
    windows = (Window(F(0), F(4)),)
    assert verdicts(Schedule(windows, profile, period=F(4)))["schedule.smooth"].verdict is Verdict.PROVED
    claim = verdicts(Schedule(windows, profile))["schedule.smooth"]
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness.values["time"] == 4


def test_margins_flip_the_claims_where_they_say():
    """Windows shrunk by the margin still hold g; shrunk by more they do not."""
    shape = Ramps(F("0.5"), F("0.5"))
    wide = replace(build_schedule([Window(F(1), F(3))], shape), windows=(Window(F("0.8"), F("3.3")),))
    claim = verdicts(wide)["schedule.support"]
    margins = {m.name: F(m.low).limit_denominator(1000) for m in claim.margins}
    assert margins == {"opening_margin": F("0.2"), "closing_margin": F("0.3")}
    for more, verdict in ((F(0), Verdict.PROVED), (F(1, 10**9), Verdict.REFUTED)):
        late = replace(wide, windows=(Window(F(1) + more, F("3.3")),))
        early = replace(wide, windows=(Window(F("0.8"), F(3) - more),))
        for schedule in (late, early):
            assert verdicts(schedule)["schedule.support"].verdict is verdict


def test_shortest_gap_is_the_margin_of_order():
    windows = (Window(F(1), F(2)), Window(F("2.5"), F(3)))
    schedule = build_schedule(windows, Hermite())
    (margin,) = verdicts(schedule)["schedule.order"].margins
    assert margin.low == margin.high == 0.5
    closer = replace(schedule, windows=(Window(F(1), F("2.5") + F(1, 10**12)), windows[1]))
    assert verdicts(closer)["schedule.order"].verdict is Verdict.REFUTED


def test_work_grows_linearly_with_windows(monkeypatch):
    """Counted, not timed: polynomial evaluations do not grow with the windows that share a shape."""
    from intermit.verify.schedule import timeline as schedule_timeline

    counts = []
    for number in (10, 1000):
        windows = [Window(F(8 * k), F(8 * k + 3)) for k in range(number)]
        schedule = build_schedule(windows, Hermite(), thruster_rise=RISE, thruster_fall=RISE)
        calls = []
        evaluate = schedule_timeline.poly.evaluate
        with monkeypatch.context() as patch:
            patch.setattr(
                schedule_timeline.poly,
                "evaluate",
                lambda p, x, e=evaluate, c=calls: (c.append(1), e(p, x))[1],
            )
            assert all(c.verdict is Verdict.PROVED for c in schedule_claims(schedule))
        counts.append(len(calls))
    assert counts[0] == counts[1]
