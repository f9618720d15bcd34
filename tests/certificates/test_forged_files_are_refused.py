"""One forged file a kind and a word: each is refused, or its words and `--scenario` tell what was forged."""

import json

import pytest
from intermit.scenario import load_scenario
from intermit.study.certify.run import certify
from intermit.study.certify.same_scenario import differences
from intermit.verify import checker

SCENARIO = """
[spacecraft]
inertia = [[3, 0, 0], [0, 2.5, 0], [0, 0, 2]]
[schedule]
period = 8
on = 0.5
on_time = 4
thruster_rise = 0.1
thruster_fall = 0.1
[initial_set]
max_angle_deg = 60
max_rate = 0.1
[[law]]
type = "{type}"
lambda = 0.6
R0 = 1
{more}
"""
PERSISTENCE = SCENARIO.format(type="persistence-filter", more="")
ADAPTIVE = SCENARIO.format(type="adaptive-scaling", more="gamma = 0.5\nk0 = 0.4")


def load(folder, name, text):
    path = folder / f"{name}.toml"
    path.write_text(text)
    return load_scenario(path)


@pytest.fixture(scope="module")
def honest(tmp_path_factory):
    scenario = load(tmp_path_factory.mktemp("honest"), "s", PERSISTENCE)
    text = certify(scenario, lambda *_: None).text
    assert all(finding.valid for finding in checker.check_text(text))
    assert differences(text, scenario) == ()
    return scenario, json.loads(text)


def alone(document, kind):
    """A file of one certificate of a kind, with its data and nothing that it does not read."""
    part = next(p for p in document["parts"] if any(c["kind"] == kind for c in p["certificates"]))
    chosen = next(c for c in part["certificates"] if c["kind"] == kind)
    part = json.loads(json.dumps({"data": part["data"], "certificates": [chosen]}))
    file = {"format": checker.FORMAT, "version": checker.VERSION, "parts": [part]}
    for _ in range(20):
        findings = checker.check_text(json.dumps(file))
        if all(f.valid for f in findings):
            return file
        stray = findings[-1].reason.removeprefix("nothing reads ").split(", ")
        for path in stray:
            node = file
            *way, last = path.removeprefix("file.").split(".")
            for key in way:
                node = node[int(key)] if isinstance(node, list) else node[key]
            del node[last]
    raise AssertionError(findings)


def put(path, value):
    def change(data, certificate):
        node = {"data": data, **certificate}
        *way, last = path.split(".")
        for key in way:
            node = node[int(key)] if isinstance(node, list) else node[key]
        node[int(last) if isinstance(node, list) else last] = value

    return change


def append(path, value):
    def change(data, certificate):
        node = {"data": data, **certificate}
        for key in path.split("."):
            node = node[key]
        node.append(value)

    return change


def no_torque(data, _certificate):
    data["law"]["program"].append("v900 = const 0")
    data["law"]["torque"] = ["v900"] * 3


def twice_the_filter(data, _certificate):
    data["law"]["program"].append(f"v900 = twice {data['law']['rates']['R']}")
    data["law"]["rates"]["R"] = "v900"


LAW = {
    "label": put("data.law.name", "adaptive-scaling"),
    "printed": put("data.law.name", "persistence-filter-as-printed"),
    "pd": put("data.law.name", "quaternion-pd"),
    "idle label": put("data.law.name", "free-motion"),
    "torque": no_torque,
    "filter": twice_the_filter,
}
NUMBERED = LAW | {"lambda": put("data.parameters.lambda", "0.61")}
SCHEDULE = {
    "knot": put("data.schedule.knots.1", "0.75"),
    "period": put("data.schedule.period", "9"),
    "shape": put("data.schedule.shapes.0", ["0", "2"]),
    "finite": lambda data, _: data["schedule"].pop("period"),
}
INERTIA = {
    "inertia": put("data.inertia.0.0", "3.1"),
    "product": put("data.inertia.0.1", "0.1"),
    "tolerance": put("data.inertia_tolerance", [["0.01"] * 3] * 3),
    "negative": put("data.inertia.0.0", "-3"),
}
WINDOWS = {"window": put("data.windows.0", ["0.6", "4.5"]), "early": put("data.windows.0", ["-7.5", "-3.5"])}
FORGED = {
    "lyapunov-identity": LAW,
    "lyapunov-derivative": NUMBERED | INERTIA | {"rate": put("claim.rate", "9")},
    "sharp-condition": INERTIA
    | {"lambda": put("data.parameters.lambda", "0.61"), "weight": put("claim.weight", "0.5")},
    "paper-condition": INERTIA | {"lambda": put("data.parameters.lambda", "0.61")},
    "schedule-order": SCHEDULE | WINDOWS | {"length": put("claim.shortest_window", "4.1")},
    "schedule-smooth": SCHEDULE,
    "schedule-support": SCHEDULE | WINDOWS,
    "schedule-uncertain-thrust": SCHEDULE | WINDOWS | {"rise": put("data.thruster.rise", "0.2")},
    "schedule-excitation": SCHEDULE | {"length": put("claim.length", "16"), "least": put("claim.least", "3")},
    "filter-start": SCHEDULE
    | {"lambda": put("data.parameters.lambda", "0.61"), "R0": put("data.parameters.R0", "1.1")}
    | {"instant": put("witness.instant", "9")},
    "filter-floor": NUMBERED
    | SCHEDULE
    | INERTIA
    | {
        "floor": put("claim.floor", "0.2"),
        "R(0)": put("data.initial.R", "2"),
        "a state more": put("data.initial.k", "1"),
        "angle": put("data.initial_set.max_angle_deg", "61"),
        "rate": put("data.initial_set.max_rate", "0.2"),
        "negative rate": put("data.initial_set.max_rate", "-0.1"),
        "other rate": put("data.initial_set.max_weighted_rate", "0.2"),
        "settling": put("claim.settling.time", "1"),
        "attitude": put("claim.settling.attitude", "0.5"),
        "rate tolerance": put("claim.settling.rate", "0.5"),
        "torque": put("claim.torque", "0.001"),
        "ratio": put("claim.ratio", "0.1"),
        "from": put("claim.ratio_from", "0"),
        "horizon": put("claim.horizon", "100"),
        "name alone": put("data.law", {"name": "adaptive-scaling"}),
    },
}
REFUTED = {
    "lyapunov-counterexample": NUMBERED
    | INERTIA
    | {
        "rate": put("claim.state.rate.0", "1000"),
        "quaternion": put("claim.state.quaternion.0", "1.01"),
        "R": put("claim.state.controller.R", "-1"),
        "g": put("claim.state.g", "-1"),
    },
    "schedule-counterexample": SCHEDULE
    | WINDOWS
    | {
        "wrap": put("claim.instant", "8"),
        "open": put("claim.instant", "2"),
        "idle": put("claim.instant", "7"),
        "later": put("claim.instant", "16"),
        "smooth": put("claim.fact", "smooth"),
    },
    "filter-start-counterexample": SCHEDULE
    | {
        "lambda": put("data.parameters.lambda", "0.31"),
        "R0": put("data.parameters.R0", "1"),
        "greatest": put("claim.greatest", "0.9"),
    },
    "floquet": SCHEDULE
    | {
        "A": put("data.plant.A.1.0", "1"),
        "B": put("data.plant.B.1.0", "2"),
        "K": put("data.plant.K.0.0", "-3"),
        "side": put("claim.side", "above"),
        "radius": put("claim.radius", "0.01"),
    },
}
FALSE = (
    SCENARIO.format(type="persistence-filter", more="")
    .replace("lambda = 0.6", "lambda = 0.3")
    .replace("R0 = 1", "R0 = 50")
    .replace("on = 0.5", "on = 0.2")
    .replace("thruster_rise = 0.1", 'shape = "hermite-as-printed"')
)
LINEAR = """
[spacecraft]
inertia = [[3, 0, 0], [0, 2.5, 0], [0, 0, 2]]
[schedule]
period = 8
on = 0.5
on_time = 4
[initial_set]
max_angle_deg = 60
[linear]
A = [[0, 1], [0, 0]]
B = [[0], [1]]
K = [[0.25, 0.5]]
"""
CASES = [(kind, word) for kind, words in (FORGED | REFUTED).items() for word in words]


@pytest.fixture(scope="module")
def refuting(tmp_path_factory):
    folder, found = tmp_path_factory.mktemp("refuting"), {}
    for name, text in (("false", FALSE), ("linear", LINEAR)):
        scenario = load(folder, name, text)
        document = json.loads(certify(scenario, lambda *_: None).text)
        held = {c["kind"] for part in document["parts"] for c in part["certificates"]}
        found |= {kind: (scenario, json.dumps(alone(document, kind))) for kind in held & REFUTED.keys()}
    return found


@pytest.fixture(scope="module")
def files(honest):
    return {kind: json.dumps(alone(honest[1], kind)) for kind in FORGED}


@pytest.mark.parametrize(("kind", "word"), CASES, ids=[f"{kind}: {word}" for kind, word in CASES])
def test_a_forged_word_is_refused_or_told(honest, files, refuting, kind, word):
    scenario, before = refuting[kind] if kind in REFUTED else (honest[0], files[kind])
    forged = json.loads(before)
    part = forged["parts"][0]
    (FORGED | REFUTED)[kind][word](part["data"], part["certificates"][0])
    text = json.dumps(forged)
    assert text != before
    findings = checker.check_text(text)
    assert not all(f.valid for f in findings) or differences(text, scenario), findings[0].claim


def test_files_of_one_kind_are_honest_before_they_are_forged(honest, files):
    for kind, text in files.items():
        assert [f.kind for f in checker.check_text(text) if f.valid] == [kind]
        assert differences(text, honest[0]) == ()


def test_refuting_files_are_honest_before_they_are_forged(refuting):
    assert refuting.keys() == REFUTED.keys()
    for scenario, text in refuting.values():
        assert all(f.valid for f in checker.check_text(text))
        assert differences(text, scenario) == ()


@pytest.mark.parametrize(
    "number", [True, "NaN", "inf", "1/0", "0x1", "1_0", " 1", "1e99999", None, [], {}, 0.5]
)
def test_what_is_no_exact_number_is_refused(files, number):
    forged = json.loads(files["filter-floor"])
    forged["parts"][0]["data"]["parameters"]["lambda"] = number
    assert not all(f.valid for f in checker.check_text(json.dumps(forged)))


def test_a_field_given_twice_is_refused(files):
    text = files["filter-start"].replace('"R0": ', '"R0": "2", "R0": ')
    assert "twice" in checker.check_text(text)[0].reason


def test_words_in_the_place_of_a_symbol_are_refused(files):
    forged = json.loads(files["lyapunov-identity"])
    law = forged["parts"][0]["data"]["law"]
    law["parameters"].append("lambda, for every law and every torque limit")
    assert "no name for a symbol" in checker.check_text(json.dumps(forged))[0].reason
    law["parameters"][-1] = "u1"
    assert "meaning of its own" in checker.check_text(json.dumps(forged))[0].reason


def old(text):
    """The file as earlier versions wrote it: the law by its name, its start among the parameters."""
    document = json.loads(text)
    data = document["parts"][0]["data"]
    data["law"] = {"name": data["law"]["name"]}
    del data["initial"]
    return json.dumps(document)


def test_an_old_floor_speaks_of_the_equations_it_prints(honest, files, tmp_path):
    text = old(files["filter-floor"])
    (finding,) = checker.check_text(text)
    assert finding.valid
    assert any("J Omega' = -Omega x J w" in line for line in finding.claim)
    assert differences(text, honest[0]) == ()
    assert differences(text, load(tmp_path, "adaptive", ADAPTIVE))
    assert differences(text, load(tmp_path, "faster", PERSISTENCE.replace("0.6", "0.7")))
    assert differences(text, load(tmp_path, "fuller", PERSISTENCE.replace("R0 = 1", "R0 = 2")))


USER = """
from __future__ import annotations
from dataclasses import dataclass
from fractions import Fraction
from intermit.models.laws import Control, ControllerState
from intermit.models.laws.persistence_filter import PersistenceFilter
@dataclass(frozen=True)
class Weak(PersistenceFilter):
    def control(self, plant, time, states, parameters):
        c = super().control(plant, time, states, parameters)
        return Control(0 * c.torque, c.state_rates, c.gain, c.gain_rate)
@dataclass(frozen=True)
class Same(PersistenceFilter):
    pass
class Jumps(PersistenceFilter):
    def reset_instants(self, schedule, start, stop):
        return (start,)
class Later(PersistenceFilter):
    @property
    def controller_states(self):
        return (ControllerState("R", Fraction(2), "s"),)
"""


def startless(text):
    """A file that holds the program, and the start of R among the parameters only."""
    document = json.loads(text)
    del document["parts"][0]["data"]["initial"]
    return json.dumps(document)


@pytest.mark.parametrize("form", ["new", "old", "startless"])
def test_a_users_law_is_compared_by_its_equations(files, tmp_path, form):
    (tmp_path / "mine.py").write_text(USER)
    table = (
        '[[law]]\ntype = "user"\nfile = "mine.py"\nclass = "{}"\nparameters = {{ lambda_ = 0.6, R0 = 1 }}\n'
    )
    start = PERSISTENCE[: PERSISTENCE.index("[[law]]")]
    scenarios = {
        name: load(tmp_path, name, start + table.format(name)) for name in ("Weak", "Same", "Jumps", "Later")
    }
    forms = {"new": str, "old": old, "startless": startless}
    text = forms[form](files["filter-floor"])
    assert all(f.valid for f in checker.check_text(text))
    assert differences(text, scenarios["Same"]) == ()
    for name in ("Weak", "Jumps", "Later"):
        assert differences(text, scenarios[name]), name
    start_file = files["filter-start"]
    assert differences(start_file, scenarios["Weak"]) == (), "its R is the filter all the same"
    for name in ("Jumps", "Later"):
        assert differences(start_file, scenarios[name]), name
