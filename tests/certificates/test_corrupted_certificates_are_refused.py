"""Seeded mutation: every scalar and 200 bulk numbers; a mutant is refused, or its claim is implied.

Of the adaptive law, whose proof is of the same kind and longer, every third scalar and 60 bulk numbers.
"""

import json
import random
from fractions import Fraction as F

import lyapunov_cases as cases
import pytest
from intermit.verify import checker
from intermit.verify.certificates import certificate_text, exact_text
from intermit.verify.lyapunov import certificates_of, lyapunov_claims

IRRELEVANT = ("R0", "k0", "gamma")
"""Parameters that do not occur in V' (gamma cancels): the proof holds for every value of them."""


def leaves(value, path=()):
    if isinstance(value, dict):
        for key, item in value.items():
            yield from leaves(item, (*path, key))
    elif isinstance(value, list):
        for i, item in enumerate(value):
            yield from leaves(item, (*path, i))
    else:
        yield path, value


def replaced(document, path, value):
    copy = json.loads(json.dumps(document))
    place = copy
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return copy


def mutants(text, generator):
    """Wrong values in place of one: numbers nudged, negated, replaced; words changed."""
    try:
        number = checker.exact(text)
    except checker.Invalid:
        words = text.split()
        if len(words) > 2 and words[2] == "const":
            yield " ".join([*words[:3], exact_text(checker.exact(words[3]) + F(1, 10**9))])
        elif len(words) > 2:
            swap = {"add": "sub", "sub": "add", "mul": "add", "div": "mul", "neg": "assign"}
            yield " ".join([*words[:2], swap.get(words[2], "neg"), *words[3:]])
            yield " ".join([*words[:3], "b1", *words[4:]])
        yield text + "x"
        return
    yield exact_text(number + F(1, 10**12))
    yield exact_text(number * (1 + F(generator.choice((-1, 1)), 10**9)) if number else F(1, 7))
    if number:
        yield exact_text(-number)


def is_valid(document, path):
    """Whether the checker accepts a file that was changed at a path; the changed place is looked at first."""
    if len(path) > 3 and path[2] == "certificates":
        part = checker.parse(json.dumps(document))["parts"].items()[path[1]]
        one = part["certificates"].items()[path[3]]
        if not checker.check_certificate(part["data"], one).valid:
            return False
    return all(f.valid for f in checker.check_text(json.dumps(document)))


def meaning(document, path):
    """What the claim at a path says of V, W and the right side, as polynomials in (beta, w)."""
    part = document["parts"][path[1]]
    law = part["data"]["law"]
    storage = part["certificates"][path[3]]["claim"]["storage"]
    names = ["b0", "b1", "b2", "b3", "w1", "w2", "w3", *law["states"], "g", "g_rate", *law["parameters"]]
    names += ["k_target", "weight", *checker.INERTIA]
    ring = checker.Ring(names, ["R", *law["parameters"]])
    program = checker.Node(storage["program"], "program")
    values = checker.run(program, ring, {name: ring.symbol(name) for name in names})
    return [values[storage[key]].terms for key in ("value", "reference", "right_side") if key in storage]


def is_implied(original, path, mutant):
    """Whether the mutant says something that the original's proof already covers."""
    if path[-1] == "name":  # what a law is called
        return True
    if path[-2:-1] == ("parameters",) and path[-1] in IRRELEVANT:
        return True
    if "storage" in path:  # other instructions for the same V and W, or other coordinates y = w + shift
        return path[-1] != "weight" and meaning(original, path) == meaning(mutant, path)
    laws = [
        checker.law_polynomials(checker.Node(d["parts"][path[1]]["data"]["law"], "law"))
        for d in (original, mutant)
    ]
    return "law" in path and laws[0] == laws[1]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("law", "step", "most"), [(cases.persistence("0.525"), 1, 200), (cases.adaptive("0.525"), 3, 60)]
)
def test_every_mutant_is_refused_or_implied(law, step, most):
    text = certificate_text(certificates_of(lyapunov_claims(law, cases.J1)))
    document = json.loads(text)
    assert all(f.valid for f in checker.check_text(text))
    generator = random.Random(2024)
    places = list(leaves(document))
    bulk = [leaf for leaf in places if "gram" in leaf[0]]
    scalars = [leaf for leaf in places if "gram" not in leaf[0]]
    chosen = scalars[::step] + generator.sample(bulk, min(most, len(bulk)))
    tried = survivors = 0
    for path, value in chosen:
        changed = generator.choice(list(mutants(value, generator)))
        mutant = replaced(document, path, changed)
        tried += 1
        if is_valid(mutant, path):
            survivors += 1
            assert is_implied(document, path, mutant), (path, value, changed)
    assert tried > 300 / step
    assert survivors < tried / 10


def test_a_certificate_for_one_body_does_not_pass_for_another():
    text = certificate_text(certificates_of(lyapunov_claims(cases.persistence("0.525"), cases.J1)))
    document = json.loads(text)
    heavier = [[exact_text(2 * x) for x in row] for row in cases.J1.exact_inertia]
    for part in document["parts"]:
        if "inertia" in part["data"]:
            part["data"]["inertia"] = heavier
    findings = checker.check_text(json.dumps(document))
    assert {f.kind for f in findings if f.valid} == {"lyapunov-identity"}
