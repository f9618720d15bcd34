"""[uncertainty] in scenario files: read, checked, certified, rechecked; refused where senseless."""

import json
from fractions import Fraction as F

import pytest
from intermit.verify import checker
from intermit.verify.certificates.format import certificate_text
from intermit.verify.robust.answer import certify_robust_floor
from intermit.verify.robust.certificate import robust_certificate
from intermit.verify.robust.consequences import consequences
from robust_attack import ADAPTIVE, question, random_robust_question

CASES = {
    "shape": {"inertia_relative": F(2, 100)},
    "push": {"disturbance": F(1, 100), "misalignment_deg": F(1, 2)},
    "learns": {"law": ADAPTIVE, "inertia_relative": F(2, 100)},
    "pushed": {"law": ADAPTIVE, "disturbance": F(1, 100)},
    "bins": {"inertia_scale": (F(-8, 100), F(8, 100)), "thrust_error_varies": "never"},
}


def written(q):
    floor = certify_robust_floor(q)
    return certificate_text([robust_certificate(floor, consequences(floor))])


@pytest.fixture(scope="module")
def texts():
    return {name: written(question(**channels)) for name, channels in CASES.items()}


def verdict(text):
    return checker.check_text(text)[0]


@pytest.mark.parametrize("name", CASES)
def test_a_certificate_is_valid(texts, name):
    finding = verdict(texts[name])
    assert finding.valid, finding.reason


def test_a_claim_up_to_a_horizon_says_so_of_every_bound(texts):
    lines = [line for line in verdict(texts["pushed"]).claim if "|w| <=" in line and "from t" in line]
    assert lines
    assert all(" up to " in line for line in lines)
    assert not any(" up to " in line for line in verdict(texts["shape"]).claim)


@pytest.mark.parametrize("seed", [4, 7, 13])
def test_certificates_of_random_questions_are_valid(seed):
    finding = verdict(written(random_robust_question(seed)))
    assert finding.valid, finding.reason


FORGERIES = {
    "wider shape": ("shape", lambda p: p["data"]["uncertainty"].update(inertia_relative="0.021")),
    "smaller rho": ("shape", lambda p: p["certificates"][0]["witness"].update(shape="0.019")),
    "a tolerance besides": ("shape", lambda p: p["data"]["uncertainty"].update(
        inertia_tolerance=[["0.01", "0", "0"], ["0", "0.01", "0"], ["0", "0", "0.01"]])),
    "a stronger push": ("push", lambda p: p["data"]["uncertainty"].update(disturbance="0.0102")),
    "a wider turn": ("push", lambda p: p["data"]["uncertainty"].update(misalignment_deg="0.55")),
    "more scale": ("bins", lambda p: p["data"]["uncertainty"].update(inertia_scale=["-0.09", "0.08"])),
    "thrust besides": ("bins", lambda p: p["data"]["uncertainty"].update(thrust_error=["-0.01", "0"])),
    "a bin gone": ("bins", lambda p: p["certificates"][0]["witness"]["bins"].pop(0)),
    "larger angle": ("shape", lambda p: p["data"]["initial_set"].update(max_angle_deg="121")),
    "larger rate": ("shape", lambda p: p["data"]["initial_set"].update(max_weighted_rate="0.31")),
    "other inertia": ("shape", lambda p: p["data"]["inertia"][0].__setitem__(0, "3.2")),
    "other lambda": ("shape", lambda p: p["data"]["parameters"].update({"lambda": "0.53"})),
    "other R(0)": ("shape", lambda p: p["data"]["initial"].update(R="0.99")),
    "greatest inertia": ("shape", lambda p: p["certificates"][0]["witness"].update(hi="3.0")),
    "least inertia": ("shape", lambda p: p["certificates"][0]["witness"].update(lo="2.3")),
    "a ratio with a push": ("push", lambda p: p["certificates"][0]["witness"]["bins"][0]["tail"].update(
        ratio="0.5")),
    "a smaller gain": ("learns", lambda p: p["data"]["initial"].update(k="0.79")),
    "another gamma": ("learns", lambda p: p["data"]["parameters"].update(gamma="0.011")),
    "a lower gain limit": ("learns", lambda p: p["certificates"][0]["witness"]["bins"][0]["tail"].update(
        gain_limit="0.8")),
    "an angle gone": ("learns", lambda p: p["certificates"][0]["witness"]["bins"].pop(2)),
    "no horizon": ("pushed", lambda p: p["certificates"][0]["claim"].pop("horizon")),
    "bounds after the horizon": ("pushed", lambda p: p["certificates"][0]["claim"]["bounds"].append(
        {"from": "1000", "gap": "0", "rate": "0"})),
    "settled after the horizon": ("pushed", lambda p: p["certificates"][0]["claim"].update(
        settling={"time": "1000", "attitude": "1/10", "rate": "1/10"})),
    "a tolerance outside the uncertainty": ("shape", lambda p: p["data"].update(
        inertia_tolerance=[["0.01", "0", "0"], ["0", "0.01", "0"], ["0", "0", "0.01"]])),
    "an unknown key": ("shape", lambda p: p["data"]["uncertainty"].update(delay="0.1")),
    "an unknown law": ("shape", lambda p: p["data"]["law"].update(name="adaptive-scaling")),
}  # fmt: skip


@pytest.mark.parametrize("name", FORGERIES)
def test_a_forged_word_is_refused(texts, name):
    case, forge = FORGERIES[name]
    file = json.loads(texts[case])
    forge(file["parts"][0])
    assert not all(f.valid for f in checker.check_text(json.dumps(file)))


def scaled(claim, factor):
    """The claim's numbers, each made stronger in turn."""
    for path in claim_paths(claim):
        other = json.loads(json.dumps(claim))
        place = other
        for key in path[:-1]:
            place = place[key]
        place[path[-1]] = str(F(place[path[-1]]) * (1 / factor if path[-1] == "floor" else factor))
        yield path, other


def claim_paths(claim):
    yield ("floor",)
    if "ratio" in claim:
        yield ("ratio",)
    if "settling" in claim:
        yield ("settling", "time")
    for i in range(len(claim["bounds"])):
        yield ("bounds", i, "gap")
        yield ("bounds", i, "rate")


@pytest.mark.parametrize("name", CASES)
def test_a_claim_stronger_by_3_per_cent_is_refused(texts, name):
    file = json.loads(texts[name])
    certificate = file["parts"][0]["certificates"][0]
    for path, claim in scaled(certificate["claim"], F(97, 100)):
        changed = json.loads(texts[name])
        changed["parts"][0]["certificates"][0]["claim"] = claim
        assert not verdict(json.dumps(changed)).valid, path


@pytest.mark.slow
@pytest.mark.parametrize("name", ["shape", "push"])
def test_a_step_with_a_tighter_bound_is_refused(texts, name):
    """Each component of a few steps moved by 1 % to its tight side."""
    tight = {"K": 1.01, "L": 0.99, "y": 0.99, "s": 0.99, "v": 0.99, "z": 0.99, "W": 0.99, "r": 1.01}
    steps = json.loads(texts[name])["parts"][0]["certificates"][0]["witness"]["bins"][0]["steps"]
    for index in range(0, len(steps), max(1, len(steps) // 5)):
        for component, factor in tight.items():
            file = json.loads(texts[name])
            bounds = file["parts"][0]["certificates"][0]["witness"]["bins"][0]["steps"][index]["bounds"]
            exponent, *mantissas = (int(x) for x in bounds[component])
            if component in ("s", "y") and index == 0 and not any(mantissas):
                continue
            bounds[component] = [str(exponent), *(str(int(m * factor)) for m in mantissas)]
            assert not verdict(json.dumps(file)).valid, (index, component)
