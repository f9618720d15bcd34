"""The example files load, carry exact numbers, and differ from each other only where they say."""

import sys
from fractions import Fraction
from pathlib import Path

import intermit
import pytest
from intermit.scenario import load_scenario

EXAMPLES = Path(intermit.__file__).parent / "examples"
FILES = sorted(EXAMPLES.glob("*.toml"))


@pytest.mark.parametrize("path", FILES, ids=lambda p: p.stem)
def test_every_example_loads_without_warning(path):
    scenario = load_scenario(path)
    assert scenario.laws
    assert scenario.warnings == ()


def test_the_paper_is_exact():
    scenario = load_scenario(EXAMPLES / "paper.toml")
    assert scenario.body.exact_inertia[0] == (Fraction("3.05"), Fraction("0.14"), Fraction("0.05"))
    assert scenario.schedule.square_integral(Fraction(0), Fraction(8)) == Fraction("2.198")
    assert scenario.schedule_choice.overruns_as_printed
    assert dict(scenario.laws[0].parameters)["lambda"] == Fraction("0.525")


def test_unstated_data_are_stated_once():
    """Every other paper file inherits the initial data: it must not restate them."""
    for path in EXAMPLES.glob("paper-*.toml"):
        text = path.read_text()
        assert 'extends = "paper.toml"' in text
        assert "[initial]" not in text
        assert load_scenario(path).initial == load_scenario(EXAMPLES / "paper.toml").initial


def test_schedule_table_as_described_is_the_period():
    """The CSV of the text and the endless period give the same g; the printed one does not."""
    period = load_scenario(EXAMPLES / "paper.toml").schedule
    described = load_scenario(EXAMPLES / "paper-table-as-described.toml").schedule
    printed = load_scenario(EXAMPLES / "paper-table-as-printed.toml").schedule
    times = [Fraction(k, 7) for k in range(7 * 60)]
    zero = Fraction(0)
    assert [described.square_integral(zero, t) for t in times] == [
        period.square_integral(zero, t) for t in times
    ]
    assert any(printed.square_integral(zero, t) != period.square_integral(zero, t) for t in times)


def test_laws_describe_the_parameters_they_take():
    from intermit.models.laws import LAWS

    for law in LAWS.values():
        keywords = {("lambda_" if p == "lambda" else p): Fraction(1) for p in law.described()}
        assert set(law(**keywords).parameters) == set(law.described())


def test_every_parameter_of_a_law_says_its_unit_and_bound():
    from intermit.models.laws import LAWS

    for law in LAWS.values():
        for parameter in law.described().values():
            assert parameter.unit, (law.name, parameter)
            assert parameter.bound, (law.name, parameter)
            assert parameter.says, (law.name, parameter)


def test_laws_build_with_exact_parameters():
    scenario = load_scenario(EXAMPLES / "paper.toml")
    law = scenario.laws[1].build()
    assert law.parameters["gamma"] == Fraction(1, 2)
    assert law.parameters == dict(scenario.laws[1].parameters)


def test_loading_imports_no_solver(tmp_path):
    import subprocess

    code = (
        "import sys; from intermit.scenario import load_scenario; "
        f"load_scenario({str(EXAMPLES / 'paper.toml')!r}); "
        "heavy = ('casadi', 'cvxpy', 'scipy.optimize', 'matplotlib', 'rich', 'flint'); "
        "print([m for m in heavy if m in sys.modules])"
    )
    done = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, check=True, cwd=tmp_path
    )
    assert done.stdout.strip() == "[]"
