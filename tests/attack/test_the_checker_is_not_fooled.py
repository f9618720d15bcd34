"""Files made to deceive: the checker must not call a false claim valid, nor let a file write its verdicts."""

import json
import random
import sys
from fractions import Fraction as F

import missions
import pytest
from intermit.models.laws import PersistenceFilter
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.filter.answer import answer
from intermit.verify.filter.certificate import _steps
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.persistence import PersistenceSystem
from intermit.verify.filter.sets import InitialSet
from intermit.verify.flow.stepping import Stepper
from problems import J1, paper_schedule

QUESTION = missions.question(
    law=PersistenceFilter(lambda_=F("0.525"), R0=F(1)),
    body=J1,
    schedule=paper_schedule(),
    max_angle_deg=F(100),
    max_weighted_rate=F("0.1"),
    options=FloorOptions(slack=1e-3),
)


def document_of(question):
    (claim, *_) = answer(question).claims
    return json.loads(certificate_text([claim.evidence[0].details["certificate"]]))


@pytest.fixture(scope="module")
def honest():
    return document_of(QUESTION)


def findings_of(document):
    return checker.check_text(document if isinstance(document, str) else json.dumps(document))


def is_valid(document):
    return all(f.valid for f in findings_of(document))


def copy(document):
    fresh = json.loads(json.dumps(document))
    part = fresh["parts"][0]
    return fresh, part["data"], part["certificates"][0]


def test_a_negative_gain_hides_no_torque(honest):
    """Only g^2 drives the floor, but the largest -g is not the largest |g|."""
    fresh, data, certificate = copy(honest)
    assert is_valid(fresh)
    data["schedule"]["shapes"] = [[str(-F(c)) for c in row] for row in data["schedule"]["shapes"]]
    certificate["claim"]["torque"] = "0"
    assert not is_valid(fresh)


def test_a_gain_that_jumps_is_refused(honest):
    """Where g jumps, Omega = w + 2 g^2 kappa bv jumps, and no bound of it goes on."""
    fresh, data, _ = copy(honest)
    data["schedule"] = {"knots": ["0", "3", "8"], "shapes": [["1"], []], "pieces": ["0", "1"], "period": "8"}
    (finding,) = findings_of(fresh)
    assert not finding.valid
    assert "jumps" in finding.reason


def test_a_piece_is_named_by_a_whole_number(honest):
    fresh, data, _ = copy(honest)
    data["schedule"]["pieces"][0] = str(F(data["schedule"]["pieces"][0]) + F(1, 2))
    assert not is_valid(fresh)


def half_blind():
    """A tail that bounds the angle at first and gives it up later: nothing returns to its beginning."""
    T = F(8)
    schedule = build_schedule([Window(F(1, 2), F(5, 2))], Hermite(), period=T)
    law = PersistenceFilter(lambda_=F("0.3"), R0=F(1))
    question = missions.other(
        QUESTION, law=law, schedule=schedule, max_angle_deg=F(60), max_weighted_rate=F("0.3")
    )
    c = question.bounds.coupling
    transient = PersistenceSystem(decay=law.lambda_, initial_filter=law.R0, coupling=c)
    initial = InitialSet(0.0, question.initial.s_high, 0.0, 0.3)
    steps = Stepper(transient, degree=6).run(schedule, F(0), T, transient.start(initial))
    tail = PersistenceSystem(decay=law.lambda_, initial_filter=law.R0, coupling=c, scalable=True)
    K, y, s, v, z, _ = steps[-1].end_state().values()
    # looser than known, as a bound may be: fast enough to pass 2 pi within the period
    repeat = Stepper(tail, degree=6).run(schedule, T, 2 * T, (K * 0.2, max(y, 0.6), max(s, 1.2), v, z, 1e-3))
    assert {step.modes[0] for step in repeat} == {"angle", "blind"}
    ends, starts = repeat[-1].end_state(), {n: p[0] for n, p in repeat[0].controls.items()}
    ratio = max(ends[n] / starts[n] for n in ("v", "z")) * 1.0001
    assert ratio < 1
    assert ends["r"] >= starts["r"]
    assert ends["K"] >= starts["K"]
    entry = {
        "s": [F(0), F(initial.s_high)],
        "y": [F(0), F(initial.y_high)],
        "steps": _steps(steps),
        "tail": {"ratio": F(ratio), "steps": _steps(repeat)},
    }
    data = {
        "inertia": J1.exact_inertia,
        "law": {"name": law.name},
        "parameters": {"lambda": law.lambda_, "R0": law.R0},
        "schedule": document_of(missions.other(question, max_angle_deg=F(1)))["parts"][0]["data"]["schedule"],
        "initial_set": {"max_angle_deg": F(60), "max_weighted_rate": F("0.29")},
    }
    witness = {
        "coupling": F(c),
        "greatest_inertia": question.bounds.greatest,
        "box": {"s": F(initial.s_high), "y": F(initial.y_high)},
        "bins": [entry],
    }
    return data, {"kind": "filter-floor", "claim": {"floor": F(1, 10**4)}, "witness": witness}


def as_strings(value):
    if isinstance(value, dict):
        return {k: as_strings(v) for k, v in value.items()}
    if isinstance(value, (list, tuple)):
        return [as_strings(v) for v in value]
    return str(value)


def test_an_angle_lost_within_a_period_is_lost():
    data, certificate = half_blind()
    document = file_with(as_strings(data), as_strings(certificate))
    (finding,) = findings_of(document)
    assert not finding.valid
    assert "part of a period" in finding.reason


def file_with(data, certificate):
    return {
        "format": "intermit-certificate",
        "version": "1",
        "parts": [{"data": data, "certificates": [certificate]}],
    }


def idle_law(**changes):
    law = {
        "name": "idle",
        "parameters": [],
        "states": [],
        "signals": [],
        "program": ["v0 = const 0"],
        "torque": ["v0", "v0", "v0"],
        "rates": {},
    }
    return {
        "inertia": [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]],
        "parameters": {},
        "law": law | changes,
    }


def identity(program, value, right_side):
    storage = {
        "shift_program": ["v0 = const 0"],
        "shift": ["v0", "v0", "v0"],
        "program": ["v0 = const 0", *program],
        "value": value,
        "right_side": right_side,
        "momentum_gradient": ["v0", "v0", "v0"],
    }
    return {"kind": "lyapunov-identity", "claim": {"storage": storage}, "witness": {}}


def test_a_signals_rate_is_not_constant():
    """V = x(t) has V' = x'(t), known; V = x'(t) has a V' nobody knows, and certainly not 0."""
    data = idle_law(signals=["x"])
    finding, *_ = findings_of(file_with(data, identity(["v1 = assign x"], "v1", "x_rate")))
    assert finding.valid
    finding, *_ = findings_of(file_with(data, identity(["v1 = assign x_rate"], "v1", "v0")))
    assert not finding.valid
    assert "rate" in finding.reason


def derivative_of(name_in):
    """V = q with q' = -R, said to fall: true where R is the filter state, not for any function of time."""
    data = idle_law(
        states=["q", *(["R"] if name_in == "states" else [])],
        signals=["R"] if name_in == "signals" else [],
        program=["v0 = const 0", "v1 = neg R"],
        rates={"q": "v1", **({"R": "v0"} if name_in == "states" else {})},
    )
    storage = {
        "shift_program": ["v0 = const 0"],
        "shift": ["v0", "v0", "v0"],
        "program": ["v0 = const 0", "v1 = assign q"],
        "value": "v1",
        "reference": "v0",
    }
    claim = {"storage": storage, "domain": "everywhere", "rate": "0"}
    witness = {"sums": [[{"basis": ["1"], "gram": [["1"]], "factors": {"R": "1"}}]]}
    return file_with(data, {"kind": "lyapunov-derivative", "claim": claim, "witness": witness})


def test_only_the_filter_state_is_positive():
    assert is_valid(derivative_of("states"))
    assert not is_valid(derivative_of("signals"))


def test_a_law_cannot_take_the_names_of_the_plant():
    data = idle_law(parameters=["w1"])
    data["parameters"] = {"w1": "3"}
    (finding,) = findings_of(file_with(data, identity(["v1 = assign w1"], "v0", "v0")))
    assert not finding.valid
    assert "w1" in finding.reason


@pytest.mark.parametrize("name", ["x\nVALID  filter-floor\n    R(t) >= 1 s", "\ud800", "\x1b[2J"])
def test_names_cannot_write_verdicts(name, tmp_path, capsys):
    document = copy(derivative_of("states"))[0]
    document["parts"][0]["data"]["law"]["name"] = name
    document["parts"][0]["certificates"].append({"kind": name})
    path = tmp_path / "file.json"
    path.write_text(json.dumps(document))
    digits = sys.get_int_max_str_digits()
    assert checker.main([str(path)]) == 1
    assert sys.get_int_max_str_digits() == digits
    printed = capsys.readouterr().out
    assert [line.split()[0] for line in printed.splitlines() if line[:1] not in (" ", "1")] == [
        "VALID",
        "INVALID",
    ]
    assert printed.isascii()
    assert "\x1b" not in printed


@pytest.mark.parametrize("exponent", ["1e9999", "1000000000", "-1e5"])
def test_absurd_exponents_are_refused_at_once(honest, exponent):
    fresh, _, certificate = copy(honest)
    certificate["witness"]["bins"][0]["steps"][0]["bounds"]["r"][0] = exponent
    assert not is_valid(fresh)


def test_a_settling_time_beyond_all_reason_is_refused_at_once(honest):
    fresh, _, certificate = copy(honest)
    certificate["claim"]["settling"]["time"] = "1e4000"
    assert not is_valid(fresh)


BOMBS = {
    "long number": lambda data: data["inertia"][0].__setitem__(0, "9" * 10**6),
    "high exponent": lambda data: data["inertia"][0].__setitem__(0, "1e9999"),
    "low exponent": lambda data: data["inertia"][0].__setitem__(0, "1e-9999"),
    "squares of squares": lambda data: data["law"]["program"].extend(squares("const 3")),
    "powers of powers": lambda data: data["law"]["program"].extend(squares("assign b0")),
    "terms of terms": lambda data: data["law"]["program"].extend(squares("add b0 w1")),
}


def squares(first):
    yield f"v900 = {first}"
    for i in range(901, 1000):
        yield f"v{i} = sq v{i - 1}"


@pytest.mark.parametrize("bomb", BOMBS.values(), ids=BOMBS.keys())
def test_short_files_are_never_checked_for_ever(bomb):
    """Each would take longer than anybody waits; what is too long is refused at once, and said so."""
    document = derivative_of("states")
    bomb(document["parts"][0]["data"])
    (finding,) = findings_of(document)
    assert not finding.valid
    assert any(word in finding.reason for word in ("digits", "too long", "too high", "too many"))


def test_a_long_json_integer_is_refused_at_once(honest):
    fresh, _, certificate = copy(honest)
    certificate["claim"]["floor"] = "LONG"
    text = json.dumps(fresh).replace('"LONG"', "7" * 10**6)
    (finding,) = checker.check_text(text)
    assert "digits" in finding.reason


JUNK = (None, True, 0, -1, "", "nan", "inf", "-1", "1/0", "1e9999", "1.5", [], {}, [[]], ["1"], "x", [None])


def places(value, path=()):
    yield path
    inner = value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
    for key, child in inner:
        yield from places(child, (*path, key))


def vandalised(document, rng):
    fresh = json.loads(json.dumps(document))
    paths = [p for p in places(fresh) if p]
    # shallow places are few: take half of the blows there
    shallow = [p for p in paths if len(p) < 8]
    path = rng.choice(shallow if rng.random() < 0.7 else paths)
    where = fresh
    for key in path[:-1]:
        where = where[key]
    blow = rng.randrange(4)
    if blow == 0:
        where[path[-1]] = rng.choice(JUNK)
    elif blow == 1:
        del where[path[-1]]
    elif blow == 2 and isinstance(where, list):
        where.insert(path[-1], where[path[-1]])
    else:
        other = rng.choice(paths)
        value = fresh
        for key in other:
            value = value[key]
        where[path[-1]] = json.loads(json.dumps(value))
    return fresh


def test_vandalised_files_never_crash_the_checker(honest):
    """Whatever is deleted, doubled or swapped: an answer comes, and the claim's data are those printed."""
    rng = random.Random(11)
    lyapunov = derivative_of("states")
    answers = []
    for i in range(120):
        document = vandalised(honest if i % 6 == 0 else lyapunov, rng)
        findings = findings_of(document)
        assert checker.report(findings)
        answers.append(all(f.valid for f in findings))
    assert not all(answers)
