"""Every backend evaluates the model that CasADi evaluates."""

from fractions import Fraction

import casadi as ca
import numpy as np
import pytest
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.laws import (
    AdaptiveScaling,
    AdaptiveScalingAsPrinted,
    PersistenceFilter,
    PersistenceFilterAsPrinted,
    QuaternionPD,
)
from intermit.models.lowering import (
    FIELD,
    RING,
    ArrayFunction,
    UnknownOperationError,
    emit_scalar,
    evaluate,
    shared,
    walk,
)
from intermit.models.rigid_body import RigidBody

BODY = RigidBody.from_rows([["3", "1/8", "1/4"], ["1/8", "4", "3/8"], ["1/4", "3/8", "5"]])
LAMBDA, GAMMA, ONE = Fraction(21, 40), Fraction(1, 10), Fraction(1)
LAWS = (
    AdaptiveScaling(LAMBDA, GAMMA, ONE, Fraction(1, 5)),
    AdaptiveScalingAsPrinted(LAMBDA, GAMMA, ONE, Fraction(1, 5)),
    PersistenceFilter(LAMBDA, ONE),
    PersistenceFilterAsPrinted(LAMBDA, ONE),
    QuaternionPD(ONE, ONE),
)


def samples(loop, count, seed=7):
    rng = np.random.default_rng(seed)
    state = rng.normal(size=(loop.state.numel(), count))
    state[7:] = np.abs(state[7:]) + 0.1
    return state, rng.normal(size=(2, count)), loop.parameter_values(), body_values(BODY)


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_arrays_and_scalars_are_bit_identical_to_casadi(law):
    loop = close_loop(law)
    function = loop.function("rates", loop.state_rate, loop.applied_torque)
    program = shared(walk(function))
    arguments = samples(loop, 1000)
    arrays = ArrayFunction(program, uniform=(2, 3), block=256)
    assert arrays.is_exact
    expected = [np.array(r) for r in function(*arguments)]
    for found, truth in zip(arrays(*arguments), expected, strict=True):
        assert np.array_equal(found, truth)
    scalar = emit_scalar(program)
    state, time, parameters, body = arguments
    for i in range(50):
        values = scalar(state[:, i].tolist(), time[:, i].tolist(), parameters.tolist(), body.tolist())
        assert values == [*expected[0][:, i], *expected[1][:, i]]


def test_sharing_saves_operations_and_keeps_every_bit():
    loop = close_loop(LAWS[0])
    plain = walk(loop.function("rates", loop.state_rate))
    lean = shared(plain)
    assert len(lean.steps) < 0.85 * len(plain.steps)
    arguments = samples(loop, 300)
    both = [ArrayFunction(p, uniform=(2, 3))(*arguments)[0] for p in (plain, lean)]
    assert np.array_equal(*both)


def test_exact_rationals_go_through_the_same_walk():
    x = ca.SX.sym("x", 2)
    program = walk(ca.Function("f", [x], [x[0] ** 2 / x[1] - 0.5, 2 * x[0] * x[1]]))
    results = evaluate(program, FIELD, [[Fraction(1, 3), Fraction(2, 7)]], Fraction)
    assert results == [[Fraction(7, 18) - Fraction(1, 2)], [Fraction(4, 21)]]


def test_an_operation_a_table_lacks_is_refused_by_name():
    x = ca.SX.sym("x")
    with pytest.raises(UnknownOperationError, match=r"uses div, sin, which this table"):
        evaluate(walk(ca.Function("f", [x], [ca.sin(x) / (x + 3)])), RING, [[Fraction(1)]], Fraction)
    with pytest.raises(UnknownOperationError, match="erfinv"):
        emit_scalar(walk(ca.Function("f", [x], [ca.erfinv(x)])))


def test_sparse_results_become_dense_with_exact_zeros():
    x = ca.SX.sym("x")
    sparse = ca.SX(3, 1)
    sparse[1] = x
    program = walk(ca.Function("f", [x], [sparse]))
    assert emit_scalar(program)([4.0]) == [0.0, 4.0, 0.0]
    assert ArrayFunction(program)(np.array([[4.0, 5.0]]))[0].tolist() == [[0, 0], [4, 5], [0, 0]]


def test_an_mx_function_is_refused():
    x = ca.MX.sym("x")
    with pytest.raises(TypeError, match="SX"):
        walk(ca.Function("f", [x], [x * x]))


def test_every_elementary_operation_agrees():
    x, y = ca.SX.sym("x"), ca.SX.sym("y")
    expressions = [
        ca.fmin(x, y), ca.fmax(x, y), ca.fabs(x), ca.sign(x), ca.if_else(x < y, x, y), ca.sqrt(y), -x,
        1 / x, x * x, 2 * x, ca.floor(x), ca.ceil(x), ca.exp(x), ca.log(y), ca.sin(x), ca.cos(x),
        ca.atan2(x, y), x**y, y**1.7, ca.tanh(x), ca.logic_and(x > 0, y > 1), ca.logic_not(x > 0),
        ca.logic_or(x > 0, y > 1), ca.copysign(y, x), ca.SX(-3.5) * x, ca.hypot(x, y), ca.eq(x, y), x != y,
    ]  # fmt: skip
    expressions = [e for e in expressions if not isinstance(e, bool)]
    function = ca.Function("f", [x, y], [ca.vertcat(*expressions)])
    program = shared(walk(function))
    points = np.abs(np.random.default_rng(3).normal(size=(2, 100))) + 0.1
    truth = np.array(function(points[:1], points[1:]))
    np.testing.assert_allclose(ArrayFunction(program)(points[:1], points[1:])[0], truth, rtol=4e-16)
    for i in range(100):
        values = emit_scalar(program)([float(points[0, i])], [float(points[1, i])])
        np.testing.assert_allclose(values, truth[:, i], rtol=4e-16)
