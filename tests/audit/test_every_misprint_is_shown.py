"""Each printed equation is refuted by an exact counterexample and its corrected form derived."""

import json
from fractions import Fraction as F

import numpy as np
import pytest
from intermit.cli.app import run
from intermit.models.laws import AdaptiveScaling, AdaptiveScalingAsPrinted
from intermit.models.simulation import simulate
from intermit.study.paper.audit import audit
from intermit.study.paper.audit.item import vanishes
from intermit.study.paper.audit.tables import CORRECTED_ROWS, PRINTED_ROWS
from intermit.verify.verdict import Verdict
from problems import J1, paper_schedule


@pytest.fixture(scope="module")
def items():
    return {item.number: item for item in audit()}


def test_all_eleven_are_demonstrated(items):
    assert list(items) == [f"E{n}" for n in range(1, 12)]
    for item in items.values():
        assert item.is_demonstrated, item.number
        violation = item.as_printed.witness.violation
        assert violation.rigorous
        assert violation.low > 0 or violation.high < 0
        assert item.printed != item.corrected


def test_counterexample_of_the_update_law_follows_by_hand(items):
    # at rest, g = 1, R = R_min = 1, k = 0: Omega = 0, V' = -2 lambda (1 - b0) + 2 |bv|^2 + 2 |bv|
    expected = F(-2) * F("0.525") * F(1, 5) + 2 * F(9, 25) + 2 * F(3, 5)
    violation = items["E1"].as_printed.witness.violation
    assert violation.low <= expected <= violation.high


def test_only_the_printed_update_turns_the_attitude_over():
    def final(law):
        return simulate(
            law, J1, paper_schedule(), quaternion=np.full(4, 0.5), rate=np.zeros(3), horizon=F(56)
        ).state(56.0)

    data = {"lambda_": F("0.525"), "gamma": F("0.1"), "R0": F(1), "k0": F(0)}
    printed, correct = final(AdaptiveScalingAsPrinted(**data)), final(AdaptiveScaling(**data))
    assert printed[0] < -0.999
    assert printed[7] < 1e-8
    assert correct[0] > 0.999
    assert correct[7] > 0.1


def test_trajectory_is_among_the_consequences(items):
    assert any("b0 = -1" in text and "k = -0.78" in text for text in items["E1"].consequences)


def test_figures_of_the_overrun(items):
    figures = {f.name: f for f in items["E9"].figures}
    assert figures["zero run, as printed"].low == pytest.approx(4.79)
    assert figures["zero run, corrected"].low == pytest.approx(4.8)
    assert figures["converged R_min, as printed"].low == pytest.approx(0.149646, abs=5e-7)
    assert figures["converged R_min, corrected"].low == pytest.approx(0.149215, abs=5e-7)


def test_tables_differ_in_two_places():
    assert len(PRINTED_ROWS) == 6
    assert len(CORRECTED_ROWS) == 7
    assert sum(row in CORRECTED_ROWS for row in PRINTED_ROWS) == 4


def test_vanishing_is_told_from_not_vanishing():
    from intermit.models.closed_loop import close_loop
    from intermit.models.laws import QuaternionPD

    loop = close_loop(QuaternionPD(F(1), F(1)))
    b0, bv = loop.plant.b0, loop.plant.bv
    norm = b0**2 + bv.T @ bv
    assert vanishes(loop, norm - 1)
    assert not vanishes(loop, norm - 1 + 1e-30 * bv[0])


def test_command_prints_every_number_and_writes_a_record(tmp_path, capsys):
    assert run(["audit", "--json", str(tmp_path / "audit.json")]) == 0
    words = capsys.readouterr().out
    assert all(f"E{n}" in words for n in range(1, 12))
    section = json.loads((tmp_path / "audit.json").read_text())["sections"]["audit"]
    verdicts = [claim["verdict"] for claim in section["claims"]]
    assert verdicts == [Verdict.REFUTED.value, Verdict.PROVED.value] * 11
