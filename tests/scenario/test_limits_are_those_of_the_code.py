"""The table of limits in docs/scenario.md holds the numbers that the code refuses by, and no others."""

from fractions import Fraction
from pathlib import Path

from intermit.models.simulation import coasting, integrate, right_hand_side, switching
from intermit.scenario import exact, files, linear, questions, scenario, schedules
from intermit.study.optimum import run as optimum
from intermit.verify.filter import answer, certify

# beside the tests, not in the installed package, which ships no docs
PAGE = (Path(__file__).parents[2] / "docs" / "scenario.md").read_text(encoding="utf-8")
LIMITS = {
    "size of a scenario, CSV or law file": (files.MAX_FILE // files.MEGABYTE, "MB"),
    "magnitude of a number": (Fraction(10) ** exact.MAX_EXPONENT, ""),
    "significant digits": (exact.MAX_NUMBER, ""),
    "`tolerance.attitude`": (1, ""),
    "`schedule.count`": (schedules.MAX_COUNT, ""),
    "after a table's end": (scenario.MAX_IDLE, "s"),
    "`simulation.output_step`": (scenario.MAX_OUTPUTS, ""),
    "(`initial.rate`)": (scenario.MAX_TURNS, ""),
    "followed turn by turn": (coasting.MAX_TURNS, ""),
    "right-hand sides": (right_hand_side.MAX_EVALUATIONS, ""),
    "switches of one run": (switching.MOST_SWITCHES, ""),
    "filter state that a gain divides by": (Fraction(str(integrate.LEAST_FILTER_STATE)), "s"),
    "windows of a transfer": (optimum.MAX_TRANSFER_WINDOWS, ""),
    "`optimum.starts`": (questions.MAX_STARTS, ""),
    "`check.samples`": (questions.MAX_SAMPLES, ""),
    "states of `linear.A`": (linear.MAX_STATES, ""),
}
"""Words of each row, and the constant that the code refuses by, with its unit."""


def rows():
    """First two cells of the table's rows."""
    section = PAGE.split("## Limits\n")[1].split("\n## ")[0]
    cells = [line.split("|")[1:3] for line in section.splitlines() if line.startswith("| ")]
    return {what.strip(): most.strip() for what, most in cells[1:]}


def test_every_limit_is_the_constant_of_the_code():
    table = rows()
    found = {words: [what for what in table if words in what] for words in LIMITS}
    assert all(len(whats) == 1 for whats in found.values()), found
    for words, (value, unit) in LIMITS.items():
        number, *rest = table[found[words][0]].removeprefix("below ").split(" to ")[-1].split()
        assert Fraction(number) == value, words
        assert rest == ([unit] if unit else []), words


def test_no_row_is_without_a_constant():
    assert len(rows()) == len(LIMITS)


def test_the_windows_that_proofs_cover_are_those_of_the_code():
    assert f"a period with more than {certify.MAX_PERIOD_WINDOWS} windows" in PAGE
    assert f"a table with more than {answer.MAX_TABLE_WINDOWS}" in PAGE
