"""Persistent excitation as a certificate: accepted as enclosed, refused a hair tighter or where g jumps."""

import json
from fractions import Fraction as F

import pytest
from intermit.models.schedule import Ramps, Window, build_schedule
from intermit.verify import checker
from intermit.verify.certificates import certificate_text, exact_text
from intermit.verify.certificates.excitation import excitation_certificate
from intermit.verify.schedule.zero_runs import longest_zero_run
from problems import paper_schedule

TABLE = build_schedule(
    [Window(F(1), F(3)), Window(F(7, 2), F(6)), Window(F(10), F(12))], Ramps(F(1, 2), F(1, 4))
)


def valid(text):
    return all(finding.valid for finding in checker.check_text(text))


@pytest.mark.parametrize(
    ("schedule", "length"),
    [(paper_schedule(), F(8)), (paper_schedule(), F(5)), (paper_schedule(), F("17.3")), (TABLE, F(6))],
)
def test_enclosed_integrals_pass_and_tighter_ones_are_refused(schedule, length):
    text = certificate_text([excitation_certificate(schedule, length)])
    assert valid(text)
    for name, sign in (("least", 1), ("greatest", -1)):
        document = json.loads(text)
        claim = document["parts"][0]["certificates"][0]["claim"]
        claim[name] = exact_text(checker.exact(claim[name]) * (1 + sign * F(1, 10**4)))
        assert not valid(json.dumps(document))


def test_one_period_holds_the_same_integral_from_every_start():
    claim = excitation_certificate(paper_schedule(), F(8)).claim
    assert claim["least"] == claim["greatest"] == paper_schedule().square_integral(F(0), F(8))


def test_an_interval_within_a_zero_run_has_no_certificate():
    run = longest_zero_run(paper_schedule())
    assert excitation_certificate(paper_schedule(), run.length) is None
    assert excitation_certificate(paper_schedule(), run.length + F(1, 10)) is not None


def test_a_gain_that_jumps_is_refused():
    document = json.loads(certificate_text([excitation_certificate(paper_schedule(), F(8))]))
    shapes = document["parts"][0]["data"]["schedule"]["shapes"]
    full = shapes.index(["1"])
    shapes[full] = ["0.999999"]
    assert "C1" in checker.check_text(json.dumps(document))[0].reason
