"""Where a coast leads is enclosed, and no torque takes the body further from it than its deviation."""

import itertools
import math
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds.prepare import Prepared, start_momentum
from intermit.optim.bounds.proof import best_departure
from intermit.optim.bounds.sets.gauge import invariant_set
from intermit.optim.bounds.sets.momentum_sets import UnitBall
from intermit.optim.bounds.windows.coast import coasts
from intermit.optim.bounds.windows.deviation import Growth, deviation_above, growth_of_deviations
from intermit.optim.bounds.windows.travel import WindowTravel
from intermit.optim.problem import TransferProblem, quaternion_from_axis_angle
from intermit.verify import checker
from intermit.verify.checker import coast_attitude, peak_coast
from scipy.integrate import solve_ivp

SPHERE = RigidBody.from_rows([[2, 0, 0], [0, 2, 0], [0, 0, 2]])
LONG = RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, "2.5"]])
TILTED = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "1.2"]])
WINDOW = PiecewisePolynomial(
    tuple(Fraction(k) for k in (0, 1, 3, 4, 7)),
    ((), (Fraction(1),), (), (Fraction(0), Fraction(4), Fraction(-4))),
)
THRUSTERS = thrusters([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
RATES = [("0.2", "-0.1", "0.15"), ("0.02", "0.03", "-0.01"), ("0", "0.3", "0.001")]


def problem(body, rate, norm=None, attitude=None):
    attitude = attitude or quaternion_from_axis_angle((1, 2, -1), 1.7)
    return TransferProblem(
        body=body,
        window=WINDOW,
        attitude=attitude,
        rate=tuple(Fraction(w) for w in rate),
        norm=norm or EUCLIDEAN,
    )


def moved(problem, torque, times, state=None):
    """Quaternion and body momentum (n, 7) at times from 0 on, by other equations than the product's."""
    inverse = np.linalg.inv(problem.body.inertia)

    def field(t, x):
        q, h = x[:4], x[4:]
        w = inverse @ h
        turned = np.concatenate([[-q[1:] @ w], q[0] * w + np.cross(q[1:], w)]) / 2
        return np.concatenate([turned, np.cross(h, w) + torque(t)])

    x = np.concatenate([problem.unit_attitude, problem.start_momentum]) if state is None else state
    exact = {"method": "DOP853", "rtol": 1e-12, "atol": 1e-14, "max_step": 0.25}
    return solve_ivp(field, (0, times[-1]), x, t_eval=times, **exact).y.T


def none(t):
    return np.zeros(3)


def rotation_vector(p, q):
    """Small rotation from p to q, body axes, rad."""
    p, q = p / np.linalg.norm(p), q / np.linalg.norm(q)
    r = np.array(
        [
            p @ q,
            *(p[0] * q[1:] - q[0] * p[1:] - np.cross(p[1:], q[1:])),
        ]
    )
    return 2 * r[1:] * np.sign(r[0])


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("body", [SPHERE, LONG, TILTED])
def test_coasts_hold_an_independent_integration(body, rate):
    case = problem(body, rate)
    found = coasts(case)
    assert (found[0].until, found[0].turn) == (0, 0)
    assert len(found) > 16
    for coast in found[:: len(found) // 4]:
        if not coast.until:
            continue
        end = moved(case, none, [float(coast.until)])[0, :4]
        off = rotation_vector(np.array([float(c) for c in coast.attitude]), end)
        assert np.linalg.norm(off) <= float(coast.turn) + 1e-10  # the integration's own error
        assert coast.turn < 1e-9


@pytest.mark.parametrize("rate", RATES)
@pytest.mark.parametrize("body", [SPHERE, LONG, TILTED])
def test_the_checker_finds_the_same_coast_by_itself(body, rate):
    case = problem(body, rate)
    coast = coasts(case)[-1]
    reached, radius = coast_attitude(
        [list(row) for row in body.exact_inertia],
        list(case.attitude),
        list(start_momentum(case)),
        coast.until,
    )
    assert radius < Fraction(1, 10**25)
    off = rotation_vector(np.array([float(c) for c in reached]), np.array([float(c) for c in coast.attitude]))
    assert np.linalg.norm(off) <= float(coast.turn) + 1e-15
    doubled = coast_attitude(
        [list(row) for row in body.exact_inertia],
        [3 * c for c in case.attitude],
        list(start_momentum(case)),
        coast.until,
    )[0]
    assert max(abs(a - 3 * b) for a, b in zip(doubled, reached, strict=True)) < Fraction(1, 10**24)


@pytest.mark.parametrize(("bits", "order"), [(192, 3), (192, 12), (40, 30), (30, 6)])
def test_errors_of_coarse_arithmetic_are_within_their_bound(monkeypatch, bits, order):
    J = [list(row) for row in TILTED.exact_inertia]
    for n in range(4):
        q = [Fraction(1), Fraction(n, 3), Fraction(-1, 2), Fraction(n, 7)]
        H = [Fraction(n - 1), Fraction(1, n + 1), Fraction(-n, 3)]
        true, error = coast_attitude(J, q, H, Fraction(n + 1))
        with monkeypatch.context() as patch:
            patch.setattr(peak_coast, "PEAK_COAST_BITS", bits)
            patch.setattr(peak_coast, "PEAK_COAST_ORDER", order)
            reached, bound = coast_attitude(J, q, H, Fraction(n + 1))
        off = checker.length_interval([a - b for a, b in zip(true, reached, strict=True)])[1]
        assert error < bound
        assert off <= bound + error


def test_long_numbers_do_not_make_a_coast_long():
    """Thousands of digits are rounded first: exact products of them took minutes."""
    long = Fraction(10**3800 + 1, 10**3800 - 3) / 10
    J = [[3 + long, long / 2, long / 3], [long / 2, 2 - long, long / 5], [long / 3, long / 5, 2 + long / 7]]
    short = [[Fraction(round(x * 10**40), 10**40) for x in row] for row in J]
    q, H = [Fraction(1), Fraction(1), Fraction(0), Fraction(0)], [Fraction(4), Fraction(-5), Fraction(2)]
    (a, error), (b, _) = (coast_attitude(M, q, H, Fraction(2)) for M in (J, short))
    assert error < Fraction(1, 10**20)
    assert max(abs(x - y) for x, y in zip(a, b, strict=True)) < Fraction(1, 10**20)


def test_coast_of_a_spin_about_an_axis_is_that_rotation():
    case = problem(SPHERE, ("0", "0", "0.25"), attitude=(Fraction(1), Fraction(0), Fraction(0), Fraction(0)))
    for coast in coasts(case)[1:]:
        q = [float(c) for c in coast.attitude]
        assert q == pytest.approx(
            [math.cos(0.125 * coast.until), 0, 0, math.sin(0.125 * coast.until)], abs=1e-15
        )


def test_a_fast_spin_is_followed_as_far_as_it_can_be_enclosed():
    """The list ends early rather than with a wide box; nothing is raised."""
    found = coasts(problem(LONG, ("9", "4", "-7")))
    assert 1 <= len(found) < 16
    assert all(coast.turn < 1e-2 for coast in found)


def test_rest_has_no_coast():
    assert [c.until for c in coasts(problem(TILTED, ("0", "0", "0")))] == [0]


def gauge(momenta, H):
    """Largest sqrt(H'M H / L) over the rows."""
    return max(
        math.sqrt(max(H @ np.array(M, dtype=float) @ H, 0) / float(level)) for M, level in momenta.rows
    )


def multiplied(p, q):
    return np.array([p[0] * q[0] - p[1:] @ q[1:], *(p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:]))])


def responses(case, times):
    """J times the small turn at the last time, per unit of momentum given at each: (n, 3, 3).

    Differences of runs from neighbouring starts give the transitions from the start, hence between times.
    """
    start = np.concatenate([case.unit_attitude, case.start_momentum])
    straight, tiny, columns = moved(case, none, times), 1e-6, []
    for k in range(6):
        other = start.copy()
        if k < 3:
            other[:4] = multiplied(start[:4], np.array([1, *(tiny / 2 * np.eye(3)[k])]))
        else:
            other[k + 1] += tiny
        run = moved(case, none, times, other)
        turns = [rotation_vector(p[:4], q[:4]) for p, q in zip(straight, run, strict=True)]
        columns.append(np.hstack([turns, run[:, 4:] - straight[:, 4:]]) / tiny)
    transition = np.stack(columns, axis=2)
    return case.body.inertia @ (transition[-1] @ np.linalg.inv(transition))[:, :3, 3:]


def worst_deviation(case, momenta, until, cells=64):
    """Deviation that the best small torque found reaches, in the gauge: each instant pushes one way."""
    edges = [until * k / cells for k in range(cells + 1)]
    opened = np.array([float(WindowTravel(WINDOW).up(Fraction(t))) for t in edges])
    middles = [(a + b) / 2 for a, b in itertools.pairwise(edges)]
    response = responses(case, [*middles, until])[:-1]
    vertices = corners(case.norm)
    worst = 0.0
    for direction in np.random.default_rng(2).standard_normal((200, 3)):
        along = np.einsum("i,nij->nj", direction, response)
        if vertices is None:
            torque = along / np.linalg.norm(along, axis=1)[:, None]
        else:
            torque = vertices[(along @ vertices.T).argmax(axis=1)]
        worst = max(worst, gauge(momenta, np.einsum("n,nij,nj->i", np.diff(opened), response, torque)))
    return worst


def window(t):
    return 1.0 if 1 <= t < 3 else 4 * ((t - 4) / 3) * (1 - (t - 4) / 3) if t >= 4 else 0.0


def corners(norm):
    if norm.is_ball:
        return None
    return np.array([[float(x) for x in v] for v in norm.corners()])


def set_of(case):
    return UnitBall(case.body) if case.norm.is_ball else invariant_set(case.body, case.norm)


def bounded(case, momenta, until, growth=None):
    growth = growth or growth_of_deviations(momenta, start_momentum(case))
    return float(deviation_above(WindowTravel(WINDOW), Fraction(until), growth))


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, THRUSTERS], ids=lambda n: n.name)
@pytest.mark.parametrize("body", [SPHERE, LONG, TILTED])
def test_no_small_torque_deviates_further(body, norm):
    """The quadrature's error, about the square of a cell over the coast, is allowed for: 0.2 %."""
    for rate in RATES[:2]:
        case = problem(body, rate, norm)
        momenta = set_of(case)
        found, bound = worst_deviation(case, momenta, 6.5), bounded(case, momenta, Fraction("6.5"))
        assert found <= 1.002 * bound
        assert found > (0.3 if any(x > 0.05 for x in map(abs, case.start_rate)) else 0.75) * bound


@pytest.mark.parametrize("unit", [Fraction(10) ** 12, Fraction(10) ** 30, Fraction(1, 10**12)])
def test_growth_does_not_depend_on_the_unit_of_inertia(unit):
    scaled = RigidBody.from_rows([[unit * x for x in row] for row in TILTED.exact_inertia])
    one, other = problem(TILTED, RATES[0], LARGEST_COMPONENT), problem(scaled, RATES[0], LARGEST_COMPONENT)
    a, b = (growth_of_deviations(set_of(c), start_momentum(c)) for c in (one, other))
    assert float(b.distance) == pytest.approx(float(a.distance), rel=1e-9)
    assert float(b.momentum) == pytest.approx(float(a.momentum), rel=1e-9)


@pytest.mark.parametrize("arm", ["1e-3", "1e-6"])
def test_a_coast_of_no_use_is_not_followed(arm):
    """Thrusters that hardly turn the body about two axes: deviations would grow beyond any number."""
    rows = [[0, 0, 1], [0, 0, -1], [arm, 0, 0], ["-" + arm, 0, 0], [0, arm, 0], [0, "-" + arm, 0]]
    case = problem(LONG, RATES[0], thrusters(rows))
    departure = best_departure(Prepared(case).measured(set_of(case)))
    assert departure.growth.allows(departure.coast.until)
    assert not departure.growth.allows(Fraction(1))
    near = RigidBody.from_rows([[1, 0, 0], [0, 1, 0], [0, 0, 1 + Fraction(1, 10**200)]])
    still = growth_of_deviations(UnitBall(near), start_momentum(problem(near, RATES[0])))
    assert 0 < still.distance < Fraction(1, 10**190)


def test_equal_inertias_reach_the_deviation():
    case = problem(SPHERE, RATES[0])
    bound = bounded(case, UnitBall(SPHERE), Fraction("6.5"))
    assert 0.99 * bound <= worst_deviation(case, UnitBall(SPHERE), 6.5) <= 1.002 * bound
    assert growth_of_deviations(UnitBall(SPHERE), start_momentum(case)) == Growth(Fraction(0), Fraction(0))


def test_without_growth_the_bound_would_be_false():
    """The partner of the tests above: a long body that tumbles does deviate further than a point mass."""
    case = problem(LONG, ("0.3", "0.3", "0.3"))
    momenta = UnitBall(LONG)
    still = Growth(Fraction(0), Fraction(0))
    assert worst_deviation(case, momenta, 6.5) > 1.02 * bounded(case, momenta, Fraction("6.5"), still)


def test_large_torques_stay_within_the_deviation_too():
    """The rotation angle times the least inertia is a lower bound of the travel."""
    rng = np.random.default_rng(5)
    for body in (SPHERE, LONG, TILTED):
        case = problem(body, RATES[0])
        bound = bounded(case, UnitBall(body), 7)
        least = float(np.linalg.eigvalsh(body.inertia)[0])
        for peak in (0.02, 0.1, 0.2):
            axis = rng.standard_normal(3)
            push = peak * axis / np.linalg.norm(axis)
            torque = lambda t, push=push: window(t) * push  # noqa: E731
            coasted, driven = moved(case, none, [7])[0, :4], moved(case, torque, [7])[0, :4]
            angle = 2 * math.acos(min(1.0, abs(float(coasted @ driven))))
            assert least * angle <= peak * bound * (1 + 1e-9)
            assert angle > 0.1 * peak
