"""Everything the command line does is one call at the root, with the command line's answers and options."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
import tomllib
from dataclasses import fields
from decimal import Decimal
from fractions import Fraction
from importlib import import_module
from pathlib import Path

import intermit
import numpy as np
import pytest
from intermit.study import options
from intermit.verify.verdict import Verdict

EXAMPLES = Path(intermit.__file__).parent / "examples"
PAPER = EXAMPLES / "paper.toml"
DOOR = ("bound", "certify", "check", "compare", "load", "optimum", "recheck", "report", "simulate", "tune")
RAMPS = {"shape": "ramps", "ramp_up": 1, "ramp_down": 1}
QUICK = {
    "spacecraft": {"inertia": np.diag([1.0, 2.0, 1.5])},
    "schedule": {"on": 0, "on_time": 4, "period": 10, "count": 3, **RAMPS},
    "initial": {"axis": (0, 0, 1), "angle_deg": 30},
    "law": [{"type": "quaternion-pd", "label": "pd", "proportional": 0.1, "derivative": Decimal("0.6")}],
    "simulation": {"horizon": 30},
    "tolerance": {"attitude": 0.2, "rate": 0.2},
    "check": {"samples": 1000},
    "tune": {"settle": 29, "evaluations": 20},
}  # fmt: skip


@pytest.fixture(scope="module")
def quick() -> intermit.Scenario:
    return intermit.load(QUICK)


def parameters(name):
    return {n: p for n, p in inspect.signature(getattr(intermit, name)).parameters.items() if n != "source"}


@pytest.mark.parametrize("name", DOOR)
def test_every_parameter_is_typed_and_documented(name):
    call = getattr(intermit, name)
    assert name in intermit.__all__
    words = inspect.getdoc(call)
    section = words.split("Parameters\n----------\n")[1].split("\n\n")[0]
    documented = re.findall(r"^(\w[\w, ]*) : ", section, flags=re.MULTILINE)
    assert [n for group in documented for n in group.split(", ")] == list(inspect.signature(call).parameters)
    for parameter in inspect.signature(call).parameters.values():
        assert parameter.annotation is not inspect.Parameter.empty
        assert parameter.kind is not inspect.Parameter.VAR_KEYWORD
    assert "Returns\n-------" in words
    assert "Raises\n------" in words


@pytest.mark.parametrize(
    ("name", "asked"),
    [
        ("check", options.CheckOptions),
        ("optimum", options.OptimumOptions),
        ("compare", options.CompareOptions),
    ],
)
def test_options_are_those_of_the_study_and_the_command(name, asked):
    stated = {f.name: f.default for f in fields(asked)}
    assert {n: p.default for n, p in parameters(name).items()} == stated
    command = inspect.signature(import_module(f"intermit.cli.{name}").run).parameters
    for option, default in stated.items():
        spelled = "norm" if option == "norms" else option
        if option == "mesh_gap":
            continue  # a call's alone
        assert options.help_of(asked, option)
        assert f"help=help_of({asked.__name__}, {option!r})" in command[spelled].annotation
        if option not in {"workers", "norms"}:  # a command may share its work; none stands for ()
            assert command[spelled].default == default


def test_a_mapping_a_path_and_a_scenario_are_taken_alike(quick, tmp_path):
    file = tmp_path / "quick.toml"
    file.write_text(quick.text)
    read = intermit.load(file)
    assert read.sha256 == quick.sha256
    assert quick.laws[0].parameters == (("proportional", Fraction(1, 10)), ("derivative", Fraction(3, 5)))
    one, two = intermit.simulate(QUICK), intermit.simulate(str(file), "pd")
    np.testing.assert_array_equal(one.torque, two.torque)


def test_a_mappings_file_lies_in_the_current_folder(tmp_path, monkeypatch):
    (tmp_path / "windows.csv").write_text("on,off\n0,4\n10,14\n")
    monkeypatch.chdir(tmp_path)
    given = QUICK | {"schedule": {"csv": Path("windows.csv"), **RAMPS}}
    assert [w.on for w in intermit.load(given).schedule.windows] == [0, 10]


def test_hostile_text_comes_back_from_toml(quick):
    from intermit.scenario.mapping import toml_text

    words = 'a"b\\c\n\t\x00\x7f é ☃ \U0001f680'
    given = {"name": words, "deep": {"a b": [1, 2.5, True, Fraction(1, 8), 1e-7, 1e22]}}
    read = tomllib.loads(toml_text(given), parse_float=Decimal)
    assert read["name"] == words
    assert [Fraction(x) for x in read["deep"]["a b"]] == [1, Fraction(5, 2), 1, Fraction(1, 8),
                                                          Fraction(1, 10**7), 10**22]  # fmt: skip


@pytest.mark.parametrize(
    ("changed", "words"),
    [
        ({"initial": {"axis": [0, 0, 1], "angel_deg": 3}}, "initial.angel_deg: unknown key (did you mean"),
        ({"spacecraft": {}}, "<dict>: spacecraft.inertia: required"),
        ({"simulation": {"horizon": float("nan")}}, "<dict>: simulation.horizon: expected a finite number"),
        ({"simulation": {"horizon": Fraction(1, 3)}}, "no finite decimal"),
        ({"simulation": {"horizon": None}}, "leave the key out"),
        ({"simulation": {3: 4}}, "expected keys of text"),
    ],
)  # fmt: skip
def test_a_wrong_mapping_is_one_line_that_names_the_key(changed, words):
    with pytest.raises(intermit.InputError) as raised:
        intermit.load(QUICK | changed)
    assert words in str(raised.value)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda s: intermit.check(s, workers=0), "workers: expected a whole number >= 1"),
        (lambda s: intermit.optimum(s, norms=["both"]), "norms: expected one of component"),
        (lambda s: intermit.optimum(s, starts=0), "starts: expected a whole number >= 1"),
        (lambda s: intermit.optimum(s, solver="best"), "solver: expected one of auto"),
        (lambda s: intermit.optimum(s, mesh_gap=0.0), "mesh_gap: expected a number > 0"),
        (lambda s: intermit.optimum(s, least_time=True), "torque_limit"),
        (lambda s: intermit.tune(s, settle="soon"), "settle: expected a number of s"),
        (lambda s: intermit.tune(s, settle=-1), "settle: expected a number > 0 s"),
        (lambda s: intermit.tune(s, norm="thrusters"), "norm: expected one of component, euclidean"),
        (lambda s: intermit.tune(s, seed=-1), "seed: expected a whole number >= 0"),
        (lambda s: intermit.simulate(s, "nobody"), "no law labelled"),
        (lambda s: intermit.report(s, "x", workers=True), "workers: expected a whole number"),
        (lambda _: intermit.recheck("no such file.json"), "no such file.json: cannot be read"),
        (lambda _: intermit.load("none.toml"), "none.toml: no such file"),
    ],
)
def test_a_wrong_option_is_one_line_that_names_it(quick, call, words):
    with pytest.raises(intermit.InputError) as raised:
        call(quick)
    assert words in str(raised.value)


def printed(result):
    """What a result shows: no line is endless, and the notebook says the same words."""
    text, html = str(result), result._repr_html_()
    assert "\n" not in repr(result)
    assert len(repr(result)) < 300
    for word in text.split():
        if word.isalpha():
            assert word in html
    return text


def drawn(axes, count):
    """Axes with names and units; closed again."""
    from matplotlib import pyplot

    assert axes.shape == (count,)
    assert all("(" in one.get_xlabel() + one.get_ylabel() for one in axes)
    pyplot.close(axes[0].figure)


def test_a_run_prints_draws_and_is_a_table(quick):
    run = intermit.simulate(quick)
    n = len(run.time)
    assert (run.time[0], run.time[-1]) == (0, 30)
    shapes = [a.shape for a in (run.quaternion, run.rate, run.command, run.torque, run.gain, run.angle)]
    assert shapes == [(n, 4), (n, 3), (n, 3), (n, 3), (n,), (n,)]
    np.testing.assert_allclose(run.torque, run.gain[:, None] * run.command, atol=1e-15)
    assert np.degrees(run.angle[0]) == pytest.approx(30)
    assert "peak torque component" in printed(run)
    assert run.controller == {}
    drawn(run.plot(), 3)
    frame = run.to_dataframe()
    assert list(frame.columns[:3]) == ["time [s]", "g", "b0"]
    assert frame["gux [N m]"].to_numpy() == pytest.approx(run.torque[:, 0])


def test_a_run_that_stops_says_why(quick):
    from intermit.study.simulated_run import Run
    from intermit.study.simulation import Simulation

    stopped = Simulation(quick, "pd", Run(None, failure="the state is no longer finite at t = 1 s"))
    assert "no longer finite" in str(stopped)
    with pytest.raises(intermit.InputError, match="pd: the state is no longer finite"):
        _ = stopped.torque


def test_a_check_prints_draws_and_is_a_table(quick):
    study = intermit.check(quick, margins=False, search=False)
    text = printed(study)
    assert study.sentence in text
    assert study.claim("schedule.order").verdict is Verdict.PROVED
    assert study.claim("schedule.order") is not study.claim("convergence", "pd")
    with pytest.raises(intermit.InputError, match="no claim 'nonsense'"):
        study.claim("nonsense")
    drawn(study.plot(), 1)
    frame = study.to_dataframe()
    assert len(frame) == len(study.all_claims)
    assert set(frame["verdict"]) <= {"PROVED", "REFUTED", "UNDECIDED"}
    with pytest.raises(intermit.InputError, match="nothing to draw"):
        intermit.check(quick, simulate=False, margins=False, search=False).plot()


def test_an_optimum_and_its_bound_print_and_draw(quick):
    study = intermit.optimum(quick, norms=["euclidean"], starts=1)
    found = study.optimum("euclidean")
    assert "euclidean" in printed(study).lower()
    drawn(study.plot(), 1)
    with pytest.raises(intermit.InputError, match="no optimum in the norm 'component'"):
        study.optimum("component")
    bound = intermit.bound(intermit.load(QUICK | {"optimum": {"norm": "euclidean"}}))
    assert 0 < bound.value <= found.answer.peak
    assert bound.value == pytest.approx(found.bound.value, rel=1e-6)
    assert "PROVED" in printed(bound)
    drawn(bound.plot(), 1)


def test_a_comparison_prints_draws_and_is_a_table():
    study = intermit.compare(QUICK | {"compare": {"norms": ["euclidean"]}})
    assert "pd" in printed(study)
    drawn(study.plot(), 1)
    (row,) = study.to_dataframe().to_dict("records")
    assert row["bound [N m]"] <= row["optimum [N m]"] <= row["peak [N m]"]
    with pytest.raises(intermit.InputError, match="compares in euclidean"):
        study.plot("component")


def test_a_search_prints_draws_and_is_a_table(quick):
    study = intermit.tune(quick)
    assert study.settling <= 29
    assert set(study.parameters) == {"proportional", "derivative"}
    assert "candidates simulated" in printed(study)
    drawn(study.plot(), 1)
    assert len(study.to_dataframe()) == len(study.history.trials)


def test_certificates_are_written_and_proved_anew(quick, tmp_path):
    found = intermit.certify(quick)
    assert "certified" in printed(found)
    file = found.write(tmp_path / "c.json")
    for source in (found, found.text, file, str(file)):
        again = intermit.recheck(source)
        assert again.valid
        assert len(again) == len(found.certificates)
    assert "VALID" in printed(again)
    broken = intermit.recheck(found.text.replace('"version": "1"', '"version": "7"'))
    assert not broken.valid
    assert "INVALID" in printed(broken)


@pytest.mark.slow
def test_a_report_with_a_front_needs_no_main_guard(tmp_path):
    script = tmp_path / "script.py"
    law = {"type": "quaternion-pd", "proportional": 0.1, "derivative": 0.6}
    body = {"inertia": [[1, 0, 0], [0, 2, 0], [0, 0, 1]]}
    given = QUICK | {"spacecraft": body, "law": [law], "report": {"front": [29]}}
    script.write_text(
        f"import intermit\nprint('begun')\n"
        f"print(intermit.report({given!r}, 'out', optimum=False, comparison=False, margins=False))\n"
    )
    done = subprocess.run([sys.executable, script], cwd=tmp_path, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert done.stdout == f"begun\n{tmp_path / 'out'}\n"
    assert (tmp_path / "out" / "report.html").is_file()


@pytest.mark.parametrize(("module", "call"), [("matplotlib.pyplot", "plot"), ("pandas", "to_dataframe")])
def test_what_is_not_installed_is_named_with_the_remedy(quick, monkeypatch, module, call):
    monkeypatch.setitem(sys.modules, module, None)
    package = module.partition(".")[0]
    with pytest.raises(ImportError, match=f"needs {package}: python -m pip install {package}"):
        getattr(intermit.simulate(quick), call)()
