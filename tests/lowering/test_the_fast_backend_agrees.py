"""heyoka evaluates the same model, to rounding."""

from fractions import Fraction

import casadi as ca
import numpy as np
import pytest
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.lowering import (
    HeyokaMissingError,
    UnknownOperationError,
    sample_function,
    shared,
    walk,
)
from intermit.models.lowering import heyoka_table as table_module
from intermit.models.rigid_body import RigidBody
from intermit.models.storage import weighted_storage

BODY = RigidBody.from_rows([["3", "1/8", "1/4"], ["1/8", "4", "3/8"], ["1/4", "3/8", "5"]])
LAWS = (
    AdaptiveScaling(Fraction(21, 40), Fraction(1, 10), Fraction(1), Fraction(1, 5)),
    PersistenceFilter(Fraction(21, 40), Fraction(1)),
)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_storage_and_its_derivative_agree_to_rounding(law):
    pytest.importorskip("heyoka")
    loop = close_loop(law)
    storage = weighted_storage(loop)
    extra = [storage.weight, *([storage.gain_target] if storage.gain_target is not None else [])]
    outputs = [storage.value, storage.derivative, storage.reference]
    program = shared(walk(ca.Function("check", [*loop.arguments, *extra], outputs)))
    rng = np.random.default_rng(2)
    state = rng.normal(size=(loop.state.numel(), 5000))
    state[:4] /= np.linalg.norm(state[:4], axis=0)
    state[7:] = np.abs(state[7:]) + 0.1
    time, constants = rng.normal(size=(2, 5000)), [np.array([1.0]), np.array([7.0])][: len(extra)]
    arguments = (state, time, loop.parameter_values(), body_values(BODY), *constants)
    uniform = tuple(range(2, 4 + len(extra)))
    plain, fast = (
        sample_function(program, uniform=uniform, backend=b)(*arguments) for b in ("default", "fast")
    )
    for a, b in zip(plain, fast, strict=True):
        # cancellation makes a few values tiny: they are judged against a thousandth of the largest
        assert np.max(np.abs(a - b) / np.maximum(np.abs(a), 1e-3 * np.abs(a).max())) < 1e-12
    # a wrong body would be seen
    other = body_values(RigidBody.from_rows([[3, 0, 0], [0, 4, 0], [0, 0, 5]]))
    wrong = sample_function(program, uniform=uniform, backend="fast")(*arguments[:3], other, *constants)
    assert np.max(np.abs(plain[1] - wrong[1])) > 1e-3


def test_comparisons_and_limits_agree():
    pytest.importorskip("heyoka")
    x = ca.SX.sym("x", 2)
    expressions = [ca.fmin(x[0], x[1]), ca.fmax(x[0], 0.5), ca.fabs(x[0]), ca.if_else(x[0] < x[1], x[0], 3)]
    program = walk(ca.Function("f", [x], [ca.vertcat(*expressions)]))
    points = np.random.default_rng(4).normal(size=(2, 37))
    plain, fast = (sample_function(program, backend=b)(points)[0] for b in ("default", "fast"))
    np.testing.assert_array_equal(plain, fast)


def test_what_heyoka_lacks_is_named():
    pytest.importorskip("heyoka")
    x = ca.SX.sym("x")
    with pytest.raises(UnknownOperationError, match="floor, which heyoka does not have"):
        sample_function(walk(ca.Function("f", [x], [ca.floor(x)])), backend="fast")


def test_without_heyoka_the_message_says_what_to_install(monkeypatch):
    monkeypatch.setattr(table_module, "heyoka_available", lambda: False)
    x = ca.SX.sym("x")
    with pytest.raises(HeyokaMissingError, match=r"pip install 'intermit\[fast\]'"):
        sample_function(walk(ca.Function("f", [x], [x * x])), backend="fast")


def test_an_unknown_backend_is_refused():
    x = ca.SX.sym("x")
    with pytest.raises(ValueError, match="'default' or 'fast', received 'gpu'"):
        sample_function(walk(ca.Function("f", [x], [x * x])), backend="gpu")
