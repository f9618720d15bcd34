"""A proof belongs to equations: a class derived from a proved law keeps it only with the same equations."""

from dataclasses import dataclass, fields, replace
from fractions import Fraction as F
from typing import ClassVar

import casadi as ca
import missions
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScaling, Control, ControllerState, Law, PersistenceFilter
from intermit.models.laws.scaled import augmented_rate, filter_rate, scaled_torque
from intermit.verify.filter.answer import answer
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.recognise import ComparedLaw, NoComparisonError, compared_law, follows_filter
from intermit.verify.lyapunov import lyapunov_claims
from intermit.verify.sampling import derivative_function
from intermit.verify.verdict import Verdict
from problems import ADAPTIVE, J1, PERSISTENCE, paper_schedule

PARENTS = {"persistence": PERSISTENCE, "adaptive": ADAPTIVE}


def child(parent, **members):
    """Object of a class derived from the parent's, with some members changed and the parent's numbers."""
    kind = dataclass(frozen=True)(type("Child", (type(parent),), members))
    return kind(**{f.name: getattr(parent, f.name) for f in fields(parent)})


def with_control(parent, change):
    def control(self, plant, time, states, parameters):
        original = type(parent).control(parent, plant, time, states, parameters)
        return change(original, plant, time, states, parameters)

    return child(parent, control=control)


def torque(change):
    return lambda c, *given: Control(change(c.torque, *given), c.state_rates, c.gain, c.gain_rate)


def rates(change):
    return lambda c, *given: Control(c.torque, change(c.state_rates, *given), c.gain, c.gain_rate)


CHANGED = {
    "no torque": torque(lambda u, *_: 0 * u),
    "other sign": torque(lambda u, *_: -u),
    "clipped": torque(lambda u, *_: ca.fmin(ca.fmax(u, -1), 1)),
    "a larger gain": torque(lambda u, *_: F(1001, 1000) * 1.0 * u),
    "hardly more": torque(lambda u, *_: u * (1 + 2.0**-52)),
    "a further term": torque(lambda u, plant, *_: u - 1e-9 * plant.w),
    "beside the sphere": torque(lambda u, plant, *_: u * (plant.b0**2 + 2 * ca.sumsqr(plant.bv))),
    "in the rate of g": torque(lambda u, plant, time, *_: u + time.g_rate * plant.bv),
    "slower filter": rates(lambda r, *_: {**r, "R": r["R"] / 2}),
    "a filter that forgets": rates(lambda r, *_: {**r, "R": r["R"] - 1}),
    "another gain stated": lambda c, *_: Control(c.torque, c.state_rates, 2 * c.gain, 2 * c.gain_rate),
    "no gain stated": lambda c, *_: Control(c.torque, c.state_rates),
    "not a number": torque(lambda u, *_: u * float("nan")),
}


@pytest.mark.parametrize("parent", PARENTS.values(), ids=PARENTS)
@pytest.mark.parametrize("change", CHANGED.values(), ids=CHANGED)
def test_changed_equations_lose_the_parents_proof(parent, change):
    with pytest.raises(NoComparisonError, match="no comparison theorem covers law Child"):
        compared_law(with_control(parent, change))


SAME = {
    "called through": lambda c, *_: c,
    "times one": torque(lambda u, *_: 2 * u / 2),
    "on the sphere": torque(lambda u, plant, *_: u * (plant.b0**2 + ca.sumsqr(plant.bv))),
    "over R": torque(lambda u, _p, _t, states, _: u * states["R"] / states["R"]),
}


@pytest.mark.parametrize("parent", PARENTS.values(), ids=PARENTS)
@pytest.mark.parametrize("change", SAME.values(), ids=SAME)
def test_the_same_equations_in_other_words_keep_it(parent, change):
    assert compared_law(with_control(parent, change)) == compared_law(parent)


def test_what_a_law_says_of_itself_is_no_evidence():
    lying = child(PERSISTENCE, parameters=property(lambda _: {"lambda": F(3), "R0": F(1)}))
    assert compared_law(lying).decay == 3, "the loop runs with what `parameters` says"
    unused = child(PERSISTENCE, parameters=property(lambda self: {"lambda": self.lambda_, "R0": F(99)}))
    assert compared_law(unused).initial_filter == 1, "R(0) is the start of the state"
    started = child(PERSISTENCE, controller_states=property(lambda _: (ControllerState("R", F(7)),)))
    assert compared_law(started).initial_filter == 7

    def fixed(self, plant, time, states, parameters):
        given = {name: ca.SX(0.5) if name == "lambda" else x for name, x in parameters.items()}
        return PersistenceFilter.control(self, plant, time, states, given)

    assert compared_law(child(PERSISTENCE, control=fixed)).decay == F(1, 2), "0.525 is not what runs"
    backwards = child(PERSISTENCE, parameters=property(lambda _: {"lambda": F(-1), "R0": F(1)}))
    with pytest.raises(NoComparisonError, match="lambda > 0"):
        compared_law(backwards)
    for start in (F(0), F(-1)):
        with pytest.raises(NoComparisonError, match=r"R\(0\) > 0"):
            compared_law(
                child(PERSISTENCE, controller_states=property(lambda _, s=start: (ControllerState("R", s),)))
            )


def test_numbers_are_read_off_the_equations():
    @dataclass(frozen=True)
    class Renamed(Law):
        name: ClassVar[str] = "adaptive-scaling"
        bandwidth: F = F(1, 2)
        speed: F = F(1, 5)
        share: F = F(3)

        @property
        def controller_states(self):
            return (ControllerState("k", F(1, 4)), ControllerState("R", F(2)))

        def control(self, plant, time, states, parameters):
            R, k = states["R"], states["k"]
            Omega = augmented_rate(plant, time, k)
            room = (1 + plant.b0) * ca.dot(Omega, plant.J @ Omega)
            attitude = parameters["share"] * ca.sumsqr(plant.bv)
            slope = parameters["speed"] * R * time.g**2 * (room + attitude)
            decay = filter_rate(plant, time, R, parameters["bandwidth"])
            return Control(scaled_torque(plant, time, k, slope), {"R": decay, "k": slope}, k, slope)

    assert compared_law(Renamed()) == ComparedLaw(True, F(1, 2), F(1, 5), F(3, 2), F(2), F(1, 4))
    assert compared_law(ADAPTIVE) == ComparedLaw(True, F("0.525"), F("0.1"), F(1), F(1), F("0.2"))
    with pytest.raises(NoComparisonError, match="gamma, a > 0"):
        compared_law(Renamed(share=F(-1)))


def test_states_that_jump_or_are_more_than_known_lose_the_proof():
    jumping = child(PERSISTENCE, reset_instants=lambda *_: (F(1),))
    with pytest.raises(NoComparisonError, match="resets"):
        compared_law(jumping)
    assert not follows_filter(close_loop(jumping))

    def control(self, plant, time, states, parameters):
        c = PersistenceFilter.control(self, plant, time, states, parameters)
        return Control(c.torque, {**c.state_rates, "x": states["x"] ** 2}, c.gain, c.gain_rate)

    names = property(lambda _: (ControllerState("R", F(1)), ControllerState("x", F(1))))
    with pytest.raises(NoComparisonError, match="controller states"):
        compared_law(child(PERSISTENCE, control=control, controller_states=names))


def test_a_patched_object_is_another_law():
    close_loop(PERSISTENCE)
    patched = replace(PERSISTENCE)

    def weak(plant, time, states, parameters):
        c = PersistenceFilter.control(patched, plant, time, states, parameters)
        return Control(0 * c.torque, c.state_rates, c.gain, c.gain_rate)

    object.__setattr__(patched, "control", weak)
    assert patched == PERSISTENCE
    with pytest.raises(NoComparisonError):
        compared_law(patched)
    twin = child(
        PERSISTENCE, __eq__=lambda *_: True, __hash__=lambda _: hash(PERSISTENCE), control=lambda *_: None
    )
    with pytest.raises(TypeError, match="must return a Control"):
        close_loop(twin)
    jumping = replace(PERSISTENCE)
    object.__setattr__(jumping, "reset_instants", lambda *_: (F(1),))
    with pytest.raises(NoComparisonError, match="resets"):
        compared_law(jumping)


def test_a_law_that_changes_its_mind_is_refused():
    asked = []

    def moody(control, *_):
        asked.append(1)
        return control if len(asked) % 2 else Control(0 * control.torque, control.state_rates)

    with pytest.raises(ValueError, match="asked again"):
        close_loop(with_control(PERSISTENCE, moody))


@pytest.mark.parametrize("value", [0.6, "0.6", None, True])
def test_parameters_that_are_not_exact_are_refused(value):
    law = child(PERSISTENCE, parameters=property(lambda _: {"lambda": value, "R0": F(1)}))
    with pytest.raises(TypeError, match="lambda must be exact"):
        close_loop(law)


def test_a_state_starts_from_a_finite_number():
    assert ControllerState("R", 1.5).initial == F(3, 2)
    for start in (float("nan"), float("inf"), "R0", None):
        with pytest.raises(ValueError, match="finite number"):
            ControllerState("R", start)


def test_a_class_patched_after_use_is_another_law(monkeypatch):
    assert compared_law(PERSISTENCE).decay == F("0.525")
    original = PersistenceFilter.control

    def weak(self, plant, time, states, parameters):
        c = original(self, plant, time, states, parameters)
        return Control(0 * c.torque, c.state_rates, c.gain, c.gain_rate)

    monkeypatch.setattr(PersistenceFilter, "control", weak)
    with pytest.raises(NoComparisonError):
        compared_law(PERSISTENCE)


QUICK = missions.question(
    law=PERSISTENCE,
    body=J1,
    schedule=paper_schedule(),
    max_angle_deg=F(60),
    torque_limit=F(100),
    options=FloorOptions(max_bins=1, slack=1e-3),
)


def test_claims_follow_the_equations():
    weak = with_control(PERSISTENCE, CHANGED["no torque"])
    found = answer(missions.other(QUICK, law=weak))
    assert [c.verdict for c in found.claims] == [Verdict.UNDECIDED] * 3
    assert all("torque does not give J Omega'" in c.reason for c in found.claims)
    assert found.converged is not None, "R is the filter still: no run stays above the converged one"
    same = answer(missions.other(QUICK, law=with_control(PERSISTENCE, SAME["called through"])))
    assert [c.verdict for c in same.claims] == [Verdict.PROVED] * 3
    slow = with_control(PERSISTENCE, CHANGED["a filter that forgets"])
    assert answer(missions.other(QUICK, law=slow)).converged is None


def test_conditions_on_lambda_speak_of_the_family_only():
    weak = with_control(PERSISTENCE, CHANGED["no torque"])
    keys = {c.key: c.verdict for c in lyapunov_claims(weak, J1)}
    assert "lambda.sharp" not in keys
    assert keys["lyapunov.identity"] is Verdict.REFUTED
    assert "lambda.sharp" in {c.key for c in lyapunov_claims(PERSISTENCE, J1)}


def test_a_false_rate_of_the_gain_is_not_sampled():
    lying = with_control(PERSISTENCE, lambda c, *_: Control(c.torque, c.state_rates, c.gain, 7 * c.gain_rate))
    with pytest.raises(ValueError, match="gain_rate"):
        derivative_function(close_loop(lying))
    derivative_function(close_loop(PERSISTENCE))


def test_parents_are_of_the_family():
    for law in (PERSISTENCE, ADAPTIVE):
        assert isinstance(law, PersistenceFilter | AdaptiveScaling)
        assert compared_law(law).decay == F("0.525")
