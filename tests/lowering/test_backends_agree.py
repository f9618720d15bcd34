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


def test_division_by_a_power_of_two_keeps_every_bit():
    x = ca.SX.sym("x", 3)
    function = ca.Function("f", [x], [x / 4, x / -0.5, x / 3, x / 5e-324, x / 2.0**1023])
    program = shared(walk(function))
    # by 3, and where 1/c is no normal number
    assert sum(step.operation == "div" for step in program.steps) == 9
    edges = [0.0, -0.0, 5e-324, -3e-323, 2.2e-308, 1.7e308, np.inf, -np.inf, 1 / 3]
    points = np.array([edges, edges[::-1], np.random.default_rng(5).normal(size=9) * 1e-308])
    for found, truth in zip(ArrayFunction(program)(points), function(points), strict=True):
        assert found.tobytes() == np.ascontiguousarray(np.array(truth)).tobytes()


def test_block_size_fits_the_cache_and_changes_no_result():
    loop = close_loop(LAWS[0])
    program = shared(walk(loop.function("rates", loop.state_rate)))
    chosen = ArrayFunction(program, uniform=(2, 3))
    assert chosen.block % 64 == 0
    assert chosen.block * chosen.buffer_count * 8 <= 1 << 20
    arguments = samples(loop, 2 * chosen.block + 5)
    expected = chosen(*arguments)[0]
    for block in (1, 7, 1000, 10**6):
        few = [a[:, :40] if i < 2 else a for i, a in enumerate(arguments)] if block == 1 else arguments
        found = ArrayFunction(program, uniform=(2, 3), block=block)(*few)[0]
        assert np.array_equal(found, expected[:, : found.shape[1]])
    with pytest.raises(ValueError, match="at least 1 sample"):
        ArrayFunction(program, block=0)


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
