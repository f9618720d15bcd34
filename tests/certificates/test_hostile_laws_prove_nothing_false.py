"""Laws and storage functions made to deceive: nothing false is proved or refuted, and nothing crashes."""

from dataclasses import dataclass, field, replace
from fractions import Fraction as F
from typing import ClassVar

import casadi as ca
import lyapunov_cases as cases
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import Control, ControllerState, Law
from intermit.models.laws.scaled import filter_rate, scaled_torque
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule.polynomial import polynomial
from intermit.models.time_signals import TimeSignal
from intermit.verify.filter.recognise import follows_filter
from intermit.verify.lyapunov import lyapunov_claims, sharp_condition, sharp_threshold
from intermit.verify.verdict import Verdict
from problems import ADAPTIVE, J1, PERSISTENCE, paper_schedule


@dataclass(frozen=True, eq=False)
class Crafted(Law):
    """A law from functions of (plant, time, states, parameters)."""

    name: ClassVar[str] = "crafted"
    torque: object
    value: object = None
    rates: dict = field(default_factory=dict)
    given: dict = field(default_factory=dict)
    times: tuple = ()

    @property
    def parameters(self):
        return self.given

    @property
    def controller_states(self):
        return tuple(ControllerState(name, F(1)) for name in self.rates)

    @property
    def signals(self):
        return self.times

    def control(self, plant, time, states, parameters):
        rates = {name: ca.SX(rate(states[name])) for name, rate in self.rates.items()}
        return Control(self.torque(plant, time, states, parameters), rates)

    def storage(self, plant, time, states, parameters):
        return None if self.value is None else self.value(plant, time, states, parameters)


def damping(plant, time, *_):
    return -time.g * plant.w


def energy(plant, *_):
    return ca.dot(plant.w, plant.J @ plant.w) / 2


def verdict(law, key="lyapunov.derivative", **options):
    claims = {c.key: c for c in lyapunov_claims(law, J1, schedule=paper_schedule(), **options)}
    return claims[key].verdict


def test_a_rate_beside_a_negative_reference_is_no_proof_of_sign():
    """V = W = -x^2 with x' = -x grows: V' = 2 x^2 <= -rho W for rho >= 2, and yet V' > 0."""
    law = Crafted(damping, lambda _p, _t, s, _: -(s["x"] ** 2), {"x": lambda x: -x})
    assert verdict(law) is Verdict.REFUTED
    assert verdict(replace(law, rates={"x": lambda x: x})) is Verdict.PROVED


@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
@pytest.mark.parametrize("lam", [F(-1), F(0)])
def test_a_lambda_that_is_not_positive_proves_nothing(law, lam):
    """4 lambda^2 J - I > 0 holds for lambda = -1 too, where V grows."""
    claims = lyapunov_claims(replace(law, lambda_=lam), J1)
    assert all(claim.verdict is not Verdict.PROVED for claim in claims)
    assert sharp_condition(lam, J1).verdict is Verdict.REFUTED


@pytest.mark.parametrize("name", ["a", "gamma"])
@pytest.mark.parametrize("value", [F(-1), F(0)])
def test_a_weight_or_rate_that_is_not_positive_proves_nothing(name, value):
    claims = lyapunov_claims(replace(ADAPTIVE, **{name: value}), J1)
    assert all(claim.verdict is Verdict.UNDECIDED for claim in claims)
    with pytest.raises(ValueError, match="positive"):
        sharp_threshold(J1, weight=F(-1))


@dataclass(frozen=True)
class WindowClosing(TimeSignal):
    """Closing time of the first window, s: a signal whose values the polynomials cannot know."""

    name: str = "window_closing"

    def on_piece(self, schedule, piece):
        return polynomial(schedule.windows[0].off)


def test_signals_at_values_that_never_occur_refute_nothing():
    """The damping is multiplied by a closing time, never negative; a free symbol could be."""
    law = Crafted(lambda p, t, *_: -t.g * t.signals["window_closing"] * p.w, energy, times=(WindowClosing(),))
    assert verdict(law) is Verdict.UNDECIDED


def test_a_false_gain_rate_is_judged_by_the_torque():
    @dataclass(frozen=True)
    class Lying(Law):
        name: ClassVar[str] = "lying"
        lambda_: F = F("0.525")
        factor: F = F(1)

        @property
        def controller_states(self):
            return (ControllerState("R", F(1)),)

        def control(self, plant, time, states, parameters):
            R = states["R"]
            rate = filter_rate(plant, time, R, parameters["lambda"])
            gain_rate = -rate / R**2
            torque = scaled_torque(plant, time, 1 / R, gain_rate)
            return Control(torque, {"R": rate}, 1 / R, 7 * gain_rate)

    assert verdict(Lying(), "lyapunov.identity") is Verdict.PROVED
    assert verdict(Lying()) is Verdict.PROVED


ODD = {
    "absolute value": lambda p, t, *_: -t.g * ca.fabs(p.w),
    "minimum": lambda p, t, *_: -t.g * ca.fmin(p.w, 1),
    "case": lambda p, t, *_: -t.g * ca.if_else(p.w[0] > 0, p.w, 2 * p.w),
    "root": lambda p, t, *_: -t.g * p.w * ca.sqrt(1 + p.w[0] ** 2),
    "division by b0": lambda p, t, *_: -t.g * p.w / p.b0,
    "division by zero": lambda p, t, *_: -t.g * p.w / 0,
    "not a number": lambda p, t, *_: -t.g * p.w * float("nan"),
    "hardly wrong": lambda p, t, *_: -t.g * p.w + 1e-12 * t.g * p.bv,
}


@pytest.mark.parametrize("torque", ODD.values(), ids=ODD.keys())
def test_what_is_no_polynomial_is_never_proved(torque):
    assert verdict(Crafted(torque, energy)) is not Verdict.PROVED


VALUES = {
    "rate of g": lambda p, t, *_: energy(p) + t.g_rate,
    "vector": lambda p, *_: p.w,
    "infinite": lambda p, *_: energy(p) + float("inf"),
    "symbol of its own": lambda p, *_: energy(p) + ca.SX.sym("b0"),
    "grows with g": lambda p, t, *_: (1 + t.g) * energy(p),
}


@pytest.mark.parametrize("value", VALUES.values(), ids=VALUES.keys())
def test_what_is_no_storage_function_is_never_proved(value):
    assert verdict(Crafted(damping, value)) is not Verdict.PROVED


@pytest.mark.parametrize("name", ["b1", "y1", "c", "s", "v1", "k_target", "J11", "weight", "g", "a b", "x\n"])
def test_a_states_name_is_not_taken_for_another_thing(name):
    """x' = x with V = energy - x^2 has V' <= 0; with V = energy + x^2 it has not, whatever x is called."""
    law = Crafted(damping, lambda p, _t, s, _: energy(p) + s[name] ** 2, {name: lambda x: x})
    assert verdict(law) is not Verdict.PROVED


def test_a_law_with_strange_symbols_or_names_twice_is_refused():
    with pytest.raises(ValueError, match="none of those it was given"):
        close_loop(Crafted(lambda p, *_: p.w * ca.SX.sym("w")))
    with pytest.raises(ValueError, match="called 'x'"):
        close_loop(Crafted(damping, rates={"x": lambda x: -x}, given={"x": F(1)}))


def test_a_storage_function_without_the_inertia_is_within_reach():
    """V' of |w|^2 needs J^-1: numbers for one body, out of reach for a box of them."""
    law = Crafted(lambda p, t, *_: -t.g * (p.J @ p.w), lambda p, *_: ca.sumsqr(p.w))
    body = RigidBody.from_rows([[2, 0, 0], [0, 2, 0], [0, 0, 2]])
    (claim,) = lyapunov_claims(law, body)
    assert claim.verdict is Verdict.PROVED
    (claim,) = lyapunov_claims(law, body, tolerance=cases.tolerance("0.1"))
    assert claim.verdict is not Verdict.PROVED
    assert verdict(law) is Verdict.REFUTED  # three different inertias: the gyroscopic term works


def test_a_state_called_r_is_no_filter_by_its_name():
    assert follows_filter(close_loop(PERSISTENCE))
    assert follows_filter(close_loop(ADAPTIVE))
    rates = {"R": lambda R: -R}
    assert not follows_filter(close_loop(Crafted(damping, rates=rates, given={"lambda": F(1)})))
    assert not follows_filter(close_loop(Crafted(damping)))
