"""A law is its equations: neither class nor name proves anything, and the labels of a file are checked."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction as F
from typing import Any

import casadi as ca
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScaling, Control, ControllerState, PersistenceFilter
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.filter.certify import comparison_system
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.recognise import NoComparisonError, compared_law
from intermit.verify.lyapunov import candidate, certificates_of, derivative_claim
from intermit.verify.lyapunov.forms import law_form
from problems import ADAPTIVE, J1, PERSISTENCE

# The built-in laws are final for type checkers; at run time a user may still derive from them.
Base: Any = PersistenceFilter
Adaptive: Any = AdaptiveScaling


def changed(control: Control, **changes: Any) -> Control:
    parts = {name: getattr(control, name) for name in ("torque", "state_rates", "gain", "gain_rate")}
    return Control(**(parts | changes))


class NoTorque(Base):
    def control(self, *arguments):
        control = super().control(*arguments)
        return changed(control, torque=0 * control.torque)


class Clipped(Base):
    def control(self, *arguments):
        control = super().control(*arguments)
        return changed(control, torque=ca.fmin(ca.fmax(control.torque, -1), 1))


class SlightlyMore(Base):
    def control(self, plant, *arguments):
        control = super().control(plant, *arguments)
        return changed(control, torque=control.torque - F(1, 10**9).__float__() * plant.w)


class OtherFilter(Base):
    def control(self, plant, time, states, parameters):
        control = super().control(plant, time, states, parameters)
        return changed(control, state_rates={"R": control.state_rates["R"] - states["R"]})


class OtherStart(Base):
    @property
    def controller_states(self):
        return (ControllerState("R", 2 * self.R0, "s"),)


class LambdaInside(Base):
    """The equations use a number where the parameter should stand."""

    def control(self, plant, time, states, parameters):
        return super().control(plant, time, states, {**parameters, "lambda": ca.SX(float(self.lambda_) / 2)})


class OtherParameters(Base):
    """What it says of its parameters has other names than what it computes with."""

    @property
    def parameters(self) -> Mapping[str, F]:
        return {"lambda_": self.lambda_, "R0": self.R0}

    def control(self, plant, time, states, parameters):
        return super().control(plant, time, states, {"lambda": parameters["lambda_"], "R0": parameters["R0"]})


class Resets(Base):
    def reset_instants(self, schedule, start, stop):
        return (start,)

    def reset(self, plant, states, parameters):
        return {"R": states["R"] / 2}


class NoLearning(Adaptive):
    def control(self, *arguments):
        control = super().control(*arguments)
        return changed(control, state_rates={**control.state_rates, "k": 0 * control.torque[0]})


class SignOfTheTerm(Adaptive):
    def attitude_term(self, plant, parameters):
        return -super().attitude_term(plant, parameters)


class SameEquations(Base):
    """Another class, another order of terms, the same polynomials."""

    name = "of my own"

    def control(self, *arguments):
        control = super().control(*arguments)
        return changed(control, torque=-(-control.torque / 2 - control.torque / 2))


WRONG = (NoTorque, Clipped, SlightlyMore, OtherFilter, Resets)
OTHER_NUMBERS = {OtherStart: ("initial_filter", 2 * PERSISTENCE.R0), LambdaInside: ("decay", F(0.2625))}


def filter_law(kind):
    return kind(lambda_=PERSISTENCE.lambda_, R0=PERSISTENCE.R0)


@pytest.mark.parametrize("kind", WRONG)
def test_a_subclass_with_other_equations_loses_the_proof(kind):
    law = filter_law(kind)
    assert comparison_system(law, BodyBounds.of(J1)) is None
    with pytest.raises(NoComparisonError, match=kind.__name__):
        compared_law(law)


@pytest.mark.parametrize("kind", OTHER_NUMBERS)
def test_numbers_are_those_of_the_equations(kind):
    name, value = OTHER_NUMBERS[kind]
    assert getattr(compared_law(filter_law(kind)), name) == value
    assert compared_law(filter_law(OtherParameters)) == compared_law(PERSISTENCE)


@pytest.mark.parametrize("kind", [NoLearning, SignOfTheTerm])
def test_an_adaptive_law_with_another_update_loses_the_proof(kind):
    law = kind(ADAPTIVE.lambda_, ADAPTIVE.gamma, ADAPTIVE.R0, ADAPTIVE.k0, ADAPTIVE.a)
    assert comparison_system(law, BodyBounds.of(J1)) is None


def test_the_same_equations_under_another_name_keep_it():
    law = filter_law(SameEquations)
    assert compared_law(law) == compared_law(PERSISTENCE)
    assert comparison_system(law, BodyBounds.of(J1)) is not None
    assert "name" not in law_form(close_loop(law)), "a label of the user's own is no part of a certificate"
    assert compared_law(ADAPTIVE).adaptive


@dataclass(frozen=True)
class Sawn(Adaptive):
    """One parameter more is no other law, nor is a start of k that is not its parameter k0."""

    more: F = F(1)

    @property
    def controller_states(self):
        return (ControllerState("R", self.R0, "s"), ControllerState("k", self.more, "1/s"))


def test_a_state_starts_where_it_starts():
    at = (ADAPTIVE.lambda_, ADAPTIVE.gamma, ADAPTIVE.R0, ADAPTIVE.k0, ADAPTIVE.a)
    assert compared_law(Sawn(*at, more=ADAPTIVE.k0)) == compared_law(ADAPTIVE)
    assert compared_law(Sawn(*at, more=ADAPTIVE.k0 + 1)).initial_gain == ADAPTIVE.k0 + 1


@pytest.fixture(scope="module")
def derivative_file():
    claim = derivative_claim(candidate(close_loop(ADAPTIVE)), J1)
    return json.loads(certificate_text(certificates_of([claim])))


def test_a_file_prints_the_law_that_its_program_is(derivative_file):
    (finding,) = checker.check_text(json.dumps(derivative_file))
    assert finding.valid
    assert any(line.startswith("law adaptive-scaling, lambda") for line in finding.claim)


@pytest.mark.parametrize("label", ["adaptive-scaling-as-printed", "persistence-filter", "quaternion-pd"])
def test_the_name_of_another_law_is_refused(derivative_file, label):
    forged = json.loads(json.dumps(derivative_file))
    forged["parts"][0]["data"]["law"]["name"] = label
    (finding,) = checker.check_text(json.dumps(forged))
    assert not finding.valid
    assert f"is not the law {label}" in finding.reason


def test_a_label_that_names_no_law_is_not_printed(derivative_file):
    forged = json.loads(json.dumps(derivative_file))
    forged["parts"][0]["data"]["law"]["name"] = "every law of the fleet"
    (finding,) = checker.check_text(json.dumps(forged))
    assert finding.valid
    assert not any("fleet" in line for line in finding.claim)
    assert any(line.startswith("law adaptive-scaling, lambda") for line in finding.claim)


def test_names_count_for_nothing_between_programs():
    own, adaptive = (law_form(close_loop(law)) for law in (PERSISTENCE, ADAPTIVE))
    assert checker.same_law(own, {**own, "name": "adaptive-scaling"})
    assert not checker.same_law(own, {**adaptive, "name": "persistence-filter"})


def test_an_open_window_at_the_wrap_is_no_counterexample():
    data = {
        "schedule": {"knots": ["0", "2", "8"], "shapes": [["1"]], "pieces": ["0", "0"], "period": "8"},
        "windows": [["0", "2"]],
    }
    outcomes = {}
    for instant in ("0", "1", "4", "8"):
        claim = {"fact": "support", "instant": instant}
        part = {
            "data": data, "certificates": [{"kind": "schedule-counterexample", "claim": claim, "witness": {}}]
        }  # fmt: skip
        file = {"format": checker.FORMAT, "version": checker.VERSION, "parts": [part]}
        (finding,) = checker.check_text(json.dumps(file))
        outcomes[instant] = finding.valid or finding.reason
    is_open = "a window is open there"
    assert outcomes == {"0": is_open, "1": is_open, "4": True, "8": is_open}
