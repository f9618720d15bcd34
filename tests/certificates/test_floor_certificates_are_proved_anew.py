"""Floor certificates: accepted as written, rejected when corrupted, never believed beyond their proof."""

import json
import random
from dataclasses import replace
from fractions import Fraction as F

import missions
import pytest
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.filter.answer import answer
from intermit.verify.filter.certificate import scaled_integers
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.convergence import analyse_convergence
from problems import ADAPTIVE, J1, PERSISTENCE, paper_schedule

QUESTION = missions.question(
    law=PERSISTENCE,
    body=J1,
    schedule=paper_schedule(),
    max_angle_deg=F(120),
    max_weighted_rate=F("0.3"),
    options=FloorOptions(max_bins=2, slack=1e-3),
)
QUESTIONS = {
    "persistence": QUESTION,
    "adaptive": missions.other(QUESTION, law=ADAPTIVE),
    "rate": missions.other(QUESTION, max_weighted_rate=None, max_rate=F("0.1")),
    "at rest": missions.other(QUESTION, max_weighted_rate=None, max_angle_deg=F(180)),
    "tolerance": missions.other(QUESTION, inertia_tolerance=((F("0.01"),) * 3,) * 3),
    "open at 0": missions.other(
        QUESTION,
        law=ADAPTIVE,
        max_weighted_rate=None,
        max_rate=F("0.05"),
        schedule=build_schedule([Window(F(1), F(3))], Hermite(), period=F(7)),
    ),
    "finite": missions.other(
        QUESTION, schedule=build_schedule([Window(F(0), F(3)), Window(F(7), F(10))], Hermite())
    ),
}


def written(question):
    (claim, *_) = answer(question).claims
    return certificate_text([claim.evidence[0].details["certificate"]])


def verdict(document):
    return all(f.valid for f in checker.check_text(json.dumps(document)))


@pytest.mark.parametrize("name", QUESTIONS)
def test_written_certificates_are_valid(name):
    findings = checker.check_text(written(QUESTIONS[name]))
    assert [f.reason for f in findings] == [""]
    assert findings[0].kind == "filter-floor"


@pytest.fixture(scope="module", params=["persistence", "adaptive"])
def certified(request):
    # two bins, one with its tail moved on; more moves only repeat such bins, and each mutant checks them all
    options = replace(QUESTION.options, settling_moves=1)
    found = answer(missions.other(QUESTIONS[request.param], options=options))
    (claim, *_) = found.claims
    return json.loads(certificate_text([claim.evidence[0].details["certificate"]])), found.floor


@pytest.fixture
def document(certified):
    return certified[0]


def places(value, path=()):
    """Paths of all numbers."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from places(inner, (*path, key))
    elif isinstance(value, list):
        for i, inner in enumerate(value):
            yield from places(inner, (*path, i))
    elif isinstance(value, str) and value[:1] in "-0123456789":
        yield path


def mutated(document, path, change):
    fresh = json.loads(json.dumps(document))
    where = fresh
    for key in path[:-1]:
        where = where[key]
    before = F(where[path[-1]])
    where[path[-1]] = str(change(before))
    return fresh, F(where[path[-1]]) != before


def is_bulk(path):
    return "bounds" in path


CHANGES = [lambda x: x * F(101, 100), lambda x: x * F(99, 100), lambda x: -x, lambda x: x + 1]


def is_implied(document, mutant, floor):
    """Whether the mutant claims no more than was proved: same loop, a set inside, a floor below.

    A later time or wider tolerances follow from the settling time proved; an earlier time or narrower
    tolerances are judged by the library's own bounds.
    """
    a, b = document["parts"][0], mutant["parts"][0]
    old, new = a["certificates"][0]["claim"], b["certificates"][0]["claim"]
    sets = a["data"]["initial_set"], b["data"]["initial_set"]
    loops = [{k: v for k, v in part["data"].items() if k != "initial_set"} for part in (a, b)]
    return (
        loops[0] == loops[1]
        and all(F(sets[1][k]) <= F(v) for k, v in sets[0].items())
        and F(new["floor"]) <= F(old["floor"])
        and F(new["ratio"]) >= F(old["ratio"])
        and F(new["ratio_from"]) >= F(old["ratio_from"])
        and F(new["torque"]) >= F(old["torque"])
        and (
            all(F(new["settling"][k]) >= F(v) for k, v in old["settling"].items())
            or is_settled(floor, *(float(F(new["settling"][k])) for k in ("time", "attitude", "rate")))
        )
    )


def is_settled(floor, time, attitude, rate):
    settling = analyse_convergence(floor, attitude=attitude, rate=rate).settling
    return settling is not None and settling <= time * (1 + 1e-9)


def same_loop(document, mutant):
    keys = ("law", "parameters", "schedule", "inertia")
    a, b = (d["parts"][0]["data"] for d in (document, mutant))
    return all(a[k] == b[k] for k in keys)


@pytest.mark.slow
def test_every_scalar_mutant_is_rejected_or_implied(certified):
    document, floor = certified
    scalars = [p for p in places(document["parts"]) if not is_bulk(p)]
    accepted = 0
    for number, path in enumerate(scalars):
        for change in (CHANGES[number % 4], CHANGES[(number + 2) % 4]):
            mutant, differs = mutated(document["parts"], path, change)
            mutant = {**document, "parts": mutant}
            if differs and verdict(mutant):
                accepted += 1
                # a proof of another loop's claim is a proof; it must then be about that loop alone
                assert is_implied(document, mutant, floor) or not same_loop(document, mutant), path
    assert accepted < len(scalars)


@pytest.mark.slow
def test_eighty_bulk_mutants_are_rejected_or_implied(certified):
    document, floor = certified
    rng = random.Random(5)
    bulk = [p for p in places(document["parts"]) if is_bulk(p)]
    rejected = 0
    for path in rng.sample(bulk, 80):
        mutant, differs = mutated(document["parts"], path, rng.choice(CHANGES))
        mutant = {**document, "parts": mutant}
        if verdict(mutant):
            assert is_implied(document, mutant, floor)  # only the witness changed: the claim is the same
        else:
            rejected += differs
    assert rejected > 40


def edit(document, change):
    fresh = json.loads(json.dumps(document))
    change(fresh["parts"][0]["data"], fresh["parts"][0]["certificates"][0])
    return verdict(fresh)


def test_more_than_was_proved_is_refused(document):
    def raise_floor(_, c):
        c["claim"]["floor"] = str(F(c["claim"]["floor"]) * F(100001, 100000) + F(1, 500))

    def widen_angle(data, _):
        data["initial_set"]["max_angle_deg"] = "121"

    def widen_rate(data, _):
        data["initial_set"]["max_weighted_rate"] = "0.31"

    def lose_a_bin(_, c):
        c["witness"]["bins"].pop()

    def lose_a_step(_, c):
        c["witness"]["bins"][0]["steps"].pop(3)

    def lose_the_tail(_, c):
        del c["witness"]["bins"][0]["tail"]

    def slow_filter(data, _):
        data["parameters"]["lambda"] = "0.6"

    def unknown_law(data, _):
        data["law"]["name"] = "quaternion-pd"

    def less_torque(_, c):
        c["claim"]["torque"] = str(F(c["claim"]["torque"]) * F(999, 1000))

    def sooner(_, c):
        c["claim"]["settling"]["time"] = str(F(c["claim"]["settling"]["time"]) - 1)

    def stray_field(_, c):
        c["claim"]["also"] = "1"

    assert edit(document, lambda *_: None)
    for change in (
        raise_floor, widen_angle, widen_rate, lose_a_bin, lose_a_step, lose_the_tail, slow_filter,
        unknown_law, less_torque, sooner, stray_field,
    ):  # fmt: skip
        assert not edit(document, change), change.__name__


def test_less_than_was_proved_is_accepted(document):
    def lower(data, c):
        c["claim"]["floor"] = "0.05"
        data["initial_set"]["max_angle_deg"] = "60"

    assert edit(document, lower)


def test_cosine_bound_is_below_and_close():
    for degrees, cosine in ((0, F(1)), (60, F(1, 2)), (90, F(0)), (120, F(-1, 2)), (180, F(-1))):
        bound = checker.cosine_below(F(degrees))
        assert cosine - F(1, 10**30) <= bound <= cosine


def test_forms_multiply_add_and_bound_exactly():
    p = checker.Form.of([F(1), F(-2), F(3, 7)])
    q = checker.Form.of([F(2, 3), F(5)])
    product, total = p * q, p + q

    def at(form, x):
        n = len(form.a) - 1
        return sum((F(c) * x**j * (1 - x) ** (n - j) for j, c in enumerate(form.a)), F(0)) / form.scale

    for x in (F(0), F(1, 3), F(5, 7), F(1)):
        assert at(product, x) == at(p, x) * at(q, x)
        assert at(total, x) == at(p, x) + at(q, x)
    assert not p.is_nonnegative()
    assert (p * p + checker.Form.constant(F(1, 50))).is_nonnegative()
    assert checker.Form.of([F(1), F(0), F(1)]).is_at_least(F(1, 2))
    assert not checker.Form.of([F(1), F(0), F(1)]).is_at_least(F(51, 100), depth=12)


def test_integers_hold_floats_exactly():
    values = [0.1, -3e-9, 0.0, 7.25]
    e, *n = scaled_integers(values)
    assert [F(k) * F(2) ** e for k in n] == [F(v) for v in values]
    assert scaled_integers([0.0, 0.0]) == [0, 0, 0]
