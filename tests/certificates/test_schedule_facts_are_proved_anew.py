"""Facts of a schedule and the filter's start as certificates: accepted as decided, refused where changed."""

import json
import random
from dataclasses import replace
from fractions import Fraction as F

import pytest
from intermit.models.schedule import (
    Hermite,
    PiecewisePolynomial,
    Ramps,
    Schedule,
    Window,
    build_schedule,
)
from intermit.verify import checker
from intermit.verify.certificates import certificate_text, exact_text
from intermit.verify.certificates.facts import fact_certificate, filter_start_certificate
from intermit.verify.schedule.facts import schedule_claims
from intermit.verify.schedule.filter_start import filter_start_claim
from intermit.verify.verdict import Verdict
from problems import ADAPTIVE, PERSISTENCE, paper_schedule

SLOW = {"thruster_rise": F("0.01"), "thruster_fall": F("0.01")}
TABLE = build_schedule(
    [Window(F(1), F(3)), Window(F(7, 2), F(6)), Window(F(10), F(12))], Ramps(F(1, 2), F(1, 4)), **SLOW
)
INSIDE = replace(paper_schedule(as_printed=False), **SLOW)
OVERRUNS = replace(paper_schedule(), **SLOW)
JUMPS = Schedule(
    (Window(F(0), F(2)),), PiecewisePolynomial((F(0), F(1), F(2)), ((F(0), F(1)), (F(2), F(-2)))), F(2)
)


def certificates(schedule):
    found = ((claim, fact_certificate(schedule, claim)) for claim in schedule_claims(schedule))
    return {claim.key: (claim.verdict, certificate) for claim, certificate in found}


def text_of(*found):
    return certificate_text(found)


def valid(text):
    return all(finding.valid for finding in checker.check_text(text))


@pytest.mark.parametrize("schedule", [INSIDE, OVERRUNS, TABLE, JUMPS])
def test_every_decided_fact_has_a_matching_certificate(schedule):
    for key, (verdict, certificate) in certificates(schedule).items():
        assert certificate is not None, key
        assert (certificate.kind == "schedule-counterexample") == (verdict is Verdict.REFUTED)
        assert valid(text_of(certificate))


def test_facts_of_one_schedule_share_its_data():
    found = [certificate for _, certificate in certificates(INSIDE).values()]
    document = json.loads(text_of(*found))
    assert len(document["parts"]) == 1
    assert [f.kind for f in checker.check_text(json.dumps(document)) if f.valid] == [
        "schedule-order",
        "schedule-smooth",
        "schedule-support",
        "schedule-uncertain-thrust",
    ]


def changed(certificate, change):
    document = json.loads(text_of(certificate))
    part = document["parts"][0]
    change(part["data"], part["certificates"][0])
    return json.dumps(document)


def test_a_longer_window_or_gap_than_there_is_is_refused():
    _, order = certificates(TABLE)["schedule.order"]
    for name in ("shortest_window", "shortest_gap"):
        for factor, good in ((F(1001, 1000), False), (F(999, 1000), True)):

            def scale(_, c, name=name, factor=factor):
                c["claim"][name] = exact_text(checker.exact(c["claim"][name]) * factor)

            assert valid(changed(order, scale)) is good


@pytest.mark.parametrize(
    ("windows", "reason"),
    [
        ([["1", "3"], ["5/2", "6"], ["10", "12"]], "closer"),
        ([["3", "1"], ["7/2", "6"], ["10", "12"]], "shorter"),
        ([["7/2", "6"], ["1", "3"], ["10", "12"]], "closer"),
        ([["-1", "3"], ["7/2", "6"], ["10", "12"]], "outside"),
        ([], "no window"),
    ],
)
def test_windows_out_of_order_are_refused(windows, reason):
    _, order = certificates(TABLE)["schedule.order"]
    (finding,) = checker.check_text(changed(order, lambda data, _: data.update(windows=windows)))
    assert reason in finding.reason


def test_the_gap_over_the_end_of_a_period_counts():
    schedule = build_schedule([Window(F(0), F(1)), Window(F(3), F(5))], Hermite(), period=F(5))
    verdict, order = certificates(schedule)["schedule.order"]
    assert verdict is Verdict.PROVED
    assert order.claim["shortest_gap"] == 0


@pytest.mark.parametrize("key", ["schedule.support", "schedule.uncertain-thrust"])
def test_a_window_that_no_longer_holds_its_piece_is_refused(key):
    _, certificate = certificates(INSIDE)[key]

    def narrower(data, _):
        data["windows"][0][1] = exact_text(F("3.21") - F(1, 10**9))

    assert not valid(changed(certificate, narrower))


def test_a_window_of_the_neighbouring_period_is_seen():
    """The thrust still falls when the next period begins, and g already acts there."""
    schedule = build_schedule([Window(F(0), F(2)), Window(F(3), F(5))], Hermite(), period=F(5))
    falling = replace(schedule, thruster_fall=F(1, 10))
    verdict, certificate = certificates(falling)["schedule.uncertain-thrust"]
    assert verdict is Verdict.REFUTED
    assert certificate.claim["instant"] < F(1, 10)
    _, innocent = certificates(schedule)["schedule.support"]
    forged = json.loads(text_of(innocent))
    forged["parts"][0]["data"]["thruster"] = {"rise": "0", "fall": "1/10"}
    forged["parts"][0]["certificates"][0]["kind"] = "schedule-uncertain-thrust"
    assert "uncertain" in checker.check_text(json.dumps(forged))[0].reason


@pytest.mark.parametrize(
    ("schedule", "key", "instant"),
    [
        (OVERRUNS, "schedule.support", "3.21"),  # the window's edge
        (OVERRUNS, "schedule.support", "2"),  # inside
        (OVERRUNS, "schedule.support", "5"),  # outside, but g = 0
        (OVERRUNS, "schedule.uncertain-thrust", "2"),
        (JUMPS, "schedule.smooth", "1/2"),  # no knot
        (OVERRUNS, "schedule.support", "-1"),
        (OVERRUNS, "schedule.support", "9"),
    ],
)
def test_an_instant_that_shows_nothing_is_refused(schedule, key, instant):
    verdict, certificate = certificates(schedule)[key]
    assert verdict is Verdict.REFUTED
    assert not valid(changed(certificate, lambda _, c: c["claim"].update(instant=instant)))


def test_a_smooth_gain_is_not_called_a_jump_at_any_knot():
    _, certificate = certificates(JUMPS)["schedule.smooth"]
    smooth = json.loads(text_of(certificates(TABLE)["schedule.smooth"][1]))["parts"][0]["data"]["schedule"]
    for instant in smooth["knots"]:

        def forge(data, c, instant=instant):
            data["schedule"] = smooth
            c["claim"]["instant"] = instant

        assert not valid(changed(certificate, forge))


@pytest.mark.parametrize("law", [PERSISTENCE, replace(ADAPTIVE, R0=F(80, 21)), replace(PERSISTENCE, R0=F(4))])
def test_the_filters_start_is_certified_as_it_was_decided(law):
    claim = filter_start_claim(paper_schedule(), decay=law.lambda_, initial=law.R0)
    certificate = filter_start_certificate(paper_schedule(), law)
    assert (certificate.kind == "filter-start") == (claim.verdict is Verdict.PROVED)
    text = text_of(certificate)
    assert valid(text)
    forged = json.loads(text)
    others = {"filter-start": "filter-start-counterexample", "filter-start-counterexample": "filter-start"}
    forged["parts"][0]["certificates"][0]["kind"] = others[certificate.kind]
    assert not valid(json.dumps(forged))


def test_a_lower_ceiling_or_a_higher_start_is_refused():
    certificate = filter_start_certificate(paper_schedule(), replace(PERSISTENCE, R0=F(80, 21)))
    nudge = 1 + F(1, 10**9)

    def lower(_, c):
        c["claim"]["greatest"] = exact_text(1 / nudge)

    def higher(data, _):
        data["parameters"]["R0"] = exact_text(F(80, 21) * nudge)

    def elsewhere(_, c):
        c["witness"]["instant"] = "0.8"

    for change in (lower, higher, elsewhere):
        assert not valid(changed(certificate, change)), change.__name__


def leaves(value, path=()):
    items = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, item in items:
        yield from leaves(item, (*path, key))
    if isinstance(value, str):
        yield path, value


IMPLIED = {
    ("claim", "shortest_window"),
    ("claim", "shortest_gap"),
    ("claim", "greatest"),
    ("claim", "instant"),
    ("witness", "instant"),
}
"""May be weakened, or moved to another instant that shows the same."""


@pytest.mark.parametrize("schedule", [INSIDE, OVERRUNS, TABLE])
def test_every_changed_number_is_refused_or_claims_no_more(schedule):
    """An accepted mutant speaks of other data, or claims less."""
    generator = random.Random(5)
    found = [certificate for _, certificate in certificates(schedule).values()]
    found.append(filter_start_certificate(schedule, PERSISTENCE))
    refused = tried = 0
    for certificate in found:
        document = json.loads(text_of(certificate))
        for path, value in leaves(document["parts"]):
            try:
                number = checker.exact(value)
            except checker.Invalid:
                continue
            mutant = json.loads(json.dumps(document))
            place = mutant["parts"]
            for step in path[:-1]:
                place = place[step]
            change = generator.choice([F(1, 10**9), F(-1, 10**9), F(1, 7), -2 * number or F(1)])
            place[path[-1]] = exact_text(number + change)
            tried += 1
            if not valid(json.dumps(mutant)):
                refused += 1
            elif "data" not in path:
                assert path[-2:] in IMPLIED, (certificate.kind, path)
    assert tried > 60
    assert refused > tried / 2
