"""Closed-loop trajectories: many runs of 56 s with 10 ms output, the same local tolerance for all.

    python benchmarks/trajectories.py [runs] [rounds]

Errors are the largest over all runs, times and states, against runs at 1e-13. The general
integrators too solve each phase between schedule knots on its own; over one span they need short
steps everywhere not to step over a window (second line).
"""

from __future__ import annotations

import sys
from fractions import Fraction
from typing import Any

import casadi as ca
import numpy as np
from common import J1, LAW, PAPER, Contender, Missing, machine, race, table
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.ensemble import Tolerances, simulate_ensemble
from intermit.models.lowering import emit_scalar, heyoka_available, shared, walk
from intermit.models.simulation.phases import phase_field, phases_between, signal_degree

HORIZON = Fraction(56)
TIMES = np.arange(5601) / 100
RTOL, ATOL = 2e-11, 2e-13
LOOP = close_loop(LAW)
PHASES = phases_between(PAPER, LAW, Fraction(0), HORIZON)
DEGREE = signal_degree(PHASES)
PARAMETERS, BODY = LOOP.parameter_values(), body_values(J1)
FIELD = phase_field(LOOP, DEGREE)


def starts(count: int) -> np.ndarray:
    rng = np.random.default_rng(0)
    q = rng.normal(size=(count, 4))
    q[:, 0] = np.abs(q[:, 0])
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return np.hstack(
        [q, rng.uniform(-0.2, 0.2, (count, 3)), np.tile(LOOP.initial_state(q[0], q[0, 1:])[7:], (count, 1))]
    )


def phase_data() -> list[tuple[float, float, float, list[float], np.ndarray]]:
    """Start, end and origin of each phase, its coefficients, and the output times within it."""
    data = []
    for phase in PHASES:
        a, b = float(phase.start), float(phase.end)
        inside = TIMES[(a < TIMES) & (b >= TIMES)] if a > 0 else TIMES[b >= TIMES]
        coefficients = phase.coefficient_array(DEGREE).ravel(order="F").tolist()
        data.append((a, b, float(phase.origin), coefficients, inside))
    return data


def scalar_field() -> Any:
    function = emit_scalar(shared(walk(FIELD)))
    parameters, body = PARAMETERS.tolist(), BODY.tolist()

    def in_phase(origin: float, coefficients: list[float]) -> Any:
        return lambda t, y: function((t - origin,), y.tolist(), coefficients, parameters, body)

    return in_phase


def casadi_field() -> Any:
    def in_phase(origin: float, coefficients: list[float]) -> Any:
        return lambda t, y: np.asarray(FIELD(t - origin, y, coefficients, PARAMETERS, BODY)).ravel()

    return in_phase


def by_scipy(x0: np.ndarray, field: Any) -> Any:
    from scipy.integrate import solve_ivp

    def run() -> np.ndarray:
        out = np.empty((len(x0), TIMES.size, 9))
        for i, x in enumerate(x0):
            first, state = 0, x
            for a, b, origin, coefficients, inside in phase_data():
                points = np.union1d(inside, [b])
                solution = solve_ivp(
                    field(origin, coefficients), (a, b), state,
                    method="DOP853", rtol=RTOL, atol=ATOL, t_eval=points,
                )  # fmt: skip
                out[i, first : first + inside.size] = solution.y[:, : inside.size].T
                first, state = first + inside.size, solution.y[:, -1]
        return out

    return run


def over_one_span(x0: np.ndarray) -> Any:
    """What not to do: the integrator meets the kinks of g, and may step over a whole window."""
    from bisect import bisect_right

    from scipy.integrate import solve_ivp

    field, data = scalar_field(), phase_data()
    begins = [a for a, *_ in data]
    fields = [field(origin, coefficients) for _, _, origin, coefficients, _ in data]

    def rate(t: float, y: np.ndarray) -> list[float]:
        return fields[max(bisect_right(begins, t) - 1, 0)](t, y)

    def run() -> np.ndarray:
        options = {"method": "DOP853", "rtol": RTOL, "atol": ATOL, "t_eval": TIMES, "max_step": 0.1}
        return np.stack([solve_ivp(rate, (0.0, float(HORIZON)), x, **options).y.T for x in x0])

    return run


def by_odeint(x0: np.ndarray) -> Any:
    from scipy.integrate import odeint

    field = scalar_field()

    def run() -> np.ndarray:
        out = np.empty((len(x0), TIMES.size, 9))
        for i, x in enumerate(x0):
            first, state = 0, x
            for a, b, origin, coefficients, inside in phase_data():
                points = np.unique(np.concatenate([[a], inside, [b]]))
                found = odeint(
                    field(origin, coefficients),
                    state,
                    points,
                    tfirst=True,
                    rtol=RTOL,
                    atol=ATOL,
                    mxstep=10000,
                )
                skipped = 0 if inside.size and inside[0] == a else 1
                out[i, first : first + inside.size] = found[skipped : skipped + inside.size]
                first, state = first + inside.size, found[-1]
        return out

    return run


def by_cvodes(x0: np.ndarray) -> Any:
    tau, x, coefficients = ca.SX.sym("tau"), ca.SX.sym("x", 9), ca.SX.sym("c", len(phase_data()[0][3]))
    ode = {
        "t": tau,
        "x": x,
        "p": coefficients,
        "ode": FIELD(tau, x, ca.reshape(coefficients, -1, DEGREE + 1), PARAMETERS, BODY),
    }
    options = {
        "reltol": RTOL, "abstol": ATOL, "linear_multistep_method": "adams",
        "nonlinear_solver_iteration": "functional", "max_num_steps": 100000,
    }  # fmt: skip
    plan = []
    for number, (a, b, origin, values, inside) in enumerate(phase_data()):
        points = np.unique(np.append(inside, b)) - origin
        leading = int(inside.size > 0 and inside[0] == a)
        solver = ca.integrator(
            f"phase{number}", "cvodes", ode, a - origin, points[leading:].tolist(), options
        )
        plan.append((solver, values, inside.size, leading))

    def run() -> np.ndarray:
        out = np.empty((len(x0), TIMES.size, 9))
        for i, start in enumerate(x0):
            first, state = 0, start
            for solver, values, size, leading in plan:
                found = np.asarray(solver(x0=state, p=values)["xf"])
                if leading:
                    out[i, first] = state
                out[i, first + leading : first + size] = found[:, : size - leading].T
                first, state = first + size, found[:, -1]
        return out

    return run


def by_ensemble(x0: np.ndarray, backend: Any) -> Any:
    if backend == "fast" and not heyoka_available():
        raise Missing("heyoka")
    tolerances = Tolerances(rtol=RTOL, atol=ATOL)
    return lambda: (
        simulate_ensemble(
            LAW, J1, PAPER, x0, horizon=HORIZON, times=TIMES, tolerances=tolerances, backend=backend
        ).states
    )


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 200
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 3
    x0 = starts(count)
    few, some = max(1, count // 50), max(1, count // 20)
    truth = simulate_ensemble(
        LAW, J1, PAPER, x0, horizon=HORIZON, times=TIMES, tolerances=Tolerances(rtol=1e-13, atol=1e-15)
    ).states
    part, tiny, share, tiny_share = x0[:some], x0[:few], some / count, few / count
    times, missing = race(
        [
            Contender("scipy DOP853 per run, scalar Python", lambda: by_scipy(part, scalar_field()), share),
            Contender("the same over one span, steps <= 0.1 s", lambda: over_one_span(tiny), tiny_share),
            Contender(
                "scipy DOP853 per run, CasADi function", lambda: by_scipy(tiny, casadi_field()), tiny_share
            ),
            Contender("scipy odeint per run, scalar Python", lambda: by_odeint(part), share),
            Contender("CasADi cvodes (Adams), SX", lambda: by_cvodes(part), share),
            Contender("intermit, default", lambda: by_ensemble(x0, "default")),
            Contender("intermit, fast (heyoka)", lambda: by_ensemble(x0, "fast")),
        ],
        rounds,
    )
    base = times[0].median
    rows = [
        [t.name, f"{count / t.median:.0f}", f"{base / t.median:.2f}",
         f"{np.abs(t.answer - truth[: len(t.answer)]).max():.0e}", f"{t.setup:.2f}"]
        for t in times
    ]  # fmt: skip
    table(
        f"Trajectories: {count} runs of 56 s, 10 ms output, rtol {RTOL:g}, atol {ATOL:g}, one thread",
        ["way", "runs/s", "ratio", "worst error", "set-up, s"],
        rows,
        [machine(), f"median of {rounds} rounds in turn; slow ways do a share of the runs", *missing],
    )


if __name__ == "__main__":
    main()
