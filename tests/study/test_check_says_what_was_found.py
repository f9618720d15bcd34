"""`intermit check` prints the verdicts first and writes a record that says the same."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from intermit.reports.record import read_record
from intermit.scenario import load_scenario
from intermit.study.check.makers import decided_claims
from intermit.study.claims.known_inertia import WIDENED
from intermit.verify.claim_table import CLAIM_KEYS

ONE_LAW = '[[law]]\ntype = "persistence-filter"\n'
Run = Callable[..., tuple[int, str, str]]
Write = Callable[..., Path]

QUICK = ("--no-margins", "--no-search", "--workers", "1")
TWO_LAWS = """
[[law]]
type = "persistence-filter"
label = "first"
[[law]]
type = "persistence-filter"
label = "second"
lambda = 0.6
"""
NEVER = ("cvxpy", "matplotlib", "jinja2", "typst")


def claims_of(record: Path, law: int = 0) -> dict[str, dict[str, object]]:
    document = json.loads(record.read_text())
    sections = document["sections"]
    found = sections["schedule"]["claims"] + sections["cases"][law]["claims"]
    return {claim["key"]: claim for claim in found}


def test_record_is_whole_and_its_outcome_is_the_exit_code(
    intermit: Run, write_scenario: Write, tmp_path: Path
) -> None:
    out = tmp_path / "found.json"
    code, text, _ = intermit("check", *QUICK, write_scenario(), "--json", out)
    record = read_record(out)
    assert record.document["outcome"]["exit_code"] == code
    assert record.document["outcome"]["sentence"] in text
    assert len(record.sections.cases) == 1
    for key, claim in claims_of(out).items():
        assert claim["title"] == CLAIM_KEYS[key].title  # one name everywhere


@pytest.mark.slow
def test_same_scenario_same_bytes_in_any_number_of_processes(
    intermit: Run, write_scenario: Write, tmp_path: Path
) -> None:
    scenario = write_scenario(TWO_LAWS)
    for name, workers in (("a", 1), ("b", 2)):
        out = tmp_path / f"{name}.json"
        intermit("check", "--no-search", "--workers", workers, scenario, "--json", out)
    for suffix in (".json", ".npz"):
        first, second = ((tmp_path / name).with_suffix(suffix).read_bytes() for name in ("a", "b"))
        assert first == second


def test_a_torque_limit_that_the_run_exceeds_is_refuted(
    intermit: Run, write_scenario: Write, tmp_path: Path
) -> None:
    """The run peaks at 8.0 N m; the certified bound, 42 N m, can prove neither limit."""
    for limit, code, verdict in (("6.0", 1, "REFUTED"), ("8.1", 3, "UNDECIDED")):
        scenario = write_scenario(f'{ONE_LAW}\n[limits]\ntorque = {limit}\nnorm = "component"\n')
        out = tmp_path / f"{limit}.json"
        assert intermit("check", *QUICK, scenario, "--json", out)[0] == code
        claim = claims_of(out)["torque.limit"]
        assert claim["verdict"] == verdict
        assert (claim["witness"] is None) == (verdict == "UNDECIDED")


def test_small_lambda_refutes_the_sign_of_v_not_convergence(
    intermit: Run, write_scenario: Write, tmp_path: Path
) -> None:
    out = tmp_path / "found.json"
    _, text, _ = intermit("check", *QUICK, write_scenario(base="paper-smaller-lambda.toml"), "--json", out)
    assert "not about the laws" in text
    claims = claims_of(out)
    assert claims["lyapunov.derivative"]["verdict"] == "REFUTED"
    assert claims["lyapunov.derivative"]["counted"] is False
    assert claims["convergence"]["verdict"] == "PROVED"
    assert claims["convergence"]["counted"] is True


def test_printed_update_is_refuted_with_a_state(intermit: Run, write_scenario: Write, tmp_path: Path) -> None:
    out = tmp_path / "found.json"
    intermit("check", *QUICK, write_scenario("", base="paper-as-printed-laws.toml"), "--json", out)
    claim = claims_of(out)["lyapunov.derivative"]
    assert claim["verdict"] == "REFUTED"
    witness = claim["witness"]
    assert isinstance(witness, dict)
    assert witness["values"]
    assert witness["violation"]["low"] > 0


def test_g_as_printed_acts_in_the_fall_uncounted(
    intermit: Run, write_scenario: Write, tmp_path: Path
) -> None:
    verdicts = {}
    for base in ("paper.toml", "paper-e9.toml"):
        out = tmp_path / f"{base}.json"
        intermit("check", *QUICK, write_scenario(base=base, name=f"case-{base}"), "--json", out)
        verdicts[base] = claims_of(out)["schedule.uncertain-thrust"]
    printed, corrected = verdicts["paper.toml"], verdicts["paper-e9.toml"]
    assert (printed["verdict"], printed["counted"]) == ("REFUTED", False)
    assert (corrected["verdict"], corrected["counted"]) == ("PROVED", True)


def test_a_tolerance_claim_says_the_law_knows_the_inertia(write_scenario: Write) -> None:
    scenario = load_scenario(write_scenario())
    law = scenario.laws[0].build()
    rows = tuple(tuple(Fraction(1, 100) for _ in range(3)) for _ in range(3))
    for tolerance, said in ((None, False), (rows, True)):
        claims = decided_claims(replace(scenario, inertia_tolerance=tolerance), law)
        widened = [c for c in claims if c.key in WIDENED]
        assert len(widened) >= 5
        assert all(("which the law knows and computes with" in c.statement) is said for c in widened)
        rate = next(c for c in claims if c.key == "lambda.rate")
        assert "with W = R (2 a (1 - b0) + Omega'J Omega)" in rate.statement


def test_listed_claims_decide_the_exit_code(intermit: Run, write_scenario: Write) -> None:
    holds = write_scenario(check='claims = ["schedule.order"]')
    assert intermit("check", *QUICK, "--no-simulate", holds)[0] == 0
    refuted = write_scenario(base="paper-smaller-lambda.toml", check='claims = ["lyapunov.derivative"]')
    assert intermit("check", *QUICK, "--no-simulate", refuted)[0] == 1


def test_unknown_claim_is_bad_input(intermit: Run, write_scenario: Write) -> None:
    code, out, err = intermit("check", *QUICK, write_scenario(check='claims = ["schedule.ordre"]'))
    assert code == 2
    assert out == ""
    assert "check.claims" in err
    assert "schedule.ordre" in err


def test_two_scenarios_stand_side_by_side(intermit: Run, write_scenario: Write, tmp_path: Path) -> None:
    first = write_scenario(name="first.toml")
    second = write_scenario(base="paper-e9.toml", name="second.toml")
    code, text, _ = intermit("check", *QUICK, "--no-simulate", first, second)
    alone, _, _ = intermit("check", *QUICK, "--no-simulate", first)
    assert code == alone
    header = next(line for line in text.splitlines() if line.startswith("The schedule"))
    assert header.split()[-2:] == ["A", "B"]
    assert intermit("check", *QUICK, first, second, "--json", tmp_path / "x.json")[0] == 2


def test_no_terminal_no_progress_bar_and_no_escape_codes(intermit: Run, write_scenario: Write) -> None:
    _, out, err = intermit("check", *QUICK, "--no-simulate", write_scenario())
    assert "\x1b" not in out + err
    assert err.count("\n") == 1


def test_check_loads_no_page_and_no_modelling_layer(write_scenario: Write) -> None:
    program = (
        "import sys; from intermit.cli.app import run; run(sys.argv[1:]); "
        f"sys.exit(str([m for m in {NEVER!r} if m in sys.modules] or ''))"
    )
    command = [sys.executable, "-c", program, "check", *QUICK, str(write_scenario())]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1  # sys.exit('') prints nothing but its text
    assert done.stderr.strip().splitlines()[-1].endswith(" s"), done.stderr


def test_interrupted_or_bad_input_writes_nothing(intermit: Run, tmp_path: Path) -> None:
    code, out, err = intermit("check", *QUICK, tmp_path / "missing.toml", "--json", tmp_path / "x.json")
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_init_writes_what_check_reads(intermit: Run, tmp_path: Path) -> None:
    code, out, _ = intermit("init", tmp_path / "new")
    assert code == 0
    path = Path(out.strip())
    assert path.is_file()
    assert intermit("init", tmp_path / "new")[0] == 2
    code, out, _ = intermit("init", "--paper", tmp_path / "paper")
    assert code == 0
    assert (tmp_path / "paper" / "paper.toml").is_file()


@pytest.mark.parametrize("arguments", [["check"], ["check", "--samples", "3"], ["chekc", "x"]])
def test_wrong_words_are_bad_input(intermit: Run, arguments: list[str]) -> None:
    code, _, err = intermit(*arguments)
    assert code == 2
    assert err.count("\n") == 1


def test_explain_lists_states_and_puts_numbers_in(intermit: Run, write_scenario: Write) -> None:
    code, keys, _ = intermit("explain")
    assert code == 0
    assert "lyapunov.derivative" in keys
    code, general, _ = intermit("explain", "lyapunov.derivative")
    assert code == 0
    assert "Ram & Akella" in general
    scenario = write_scenario(base="paper-smaller-lambda.toml")
    code, found, _ = intermit("explain", "lyapunov.derivative", scenario)
    assert code == 0
    assert "REFUTED" in found
    assert found.startswith(general)
    assert intermit("explain", "lyapunov.nothing")[0] == 2
