"""Build and solve one transfer with four tools, in one run: the paper's scenario, seven windows.

    python benchmarks/optimum.py [rounds]

Same body, same windows, same ten equal cells a window with constant torque, so the same optimum.
Each round builds everything anew and solves, the tools taking turns; medians of processor time (one
thread each) are printed. The imports are not counted. Every answer is integrated again by the
package's independent check, so that the accuracy stands beside the time.
"""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import contextlib
import importlib.util
import io
import statistics
import sys
import time
from collections.abc import Callable
from fractions import Fraction
from typing import Any

import casadi as ca
import clarabel  # noqa: F401  imports are not part of the times
import numpy as np
import scipy.integrate
import scipy.sparse  # noqa: F401
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, Norm
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.optim.peak import NonlinearProgram, SequentialConvex, TorqueHistory, replay
from intermit.optim.peak.search import guess
from intermit.optim.peak.solvers import curvature
from intermit.optim.peak.transcription import mesh, propagate, scaling, shooting
from intermit.optim.problem import TransferProblem

CELLS = 10
GAP_STEPS = 8
"""Runge-Kutta steps of the general tools over a gap of 4.79 s; over a cell of 0.32 s, one."""
OPTI_EXPANDS = os.environ.get("OPTI_EXPANDS", "0") == "1"
ROCKIT_EXPANDS = os.environ.get("ROCKIT_EXPANDS", "1") == "1"
"""Each general tool with the setting that was the faster of the two for it."""
INERTIA = [["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]]
J = np.array([[float(x) for x in row] for row in INERTIA])
START = [0.5, 0.5, 0.5, 0.5, 0.0, 0.0, 0.0]


def problem(norm: Norm, horizon: str = "51.22") -> TransferProblem:
    window = Window(Fraction("0.01"), Fraction("3.21"))
    schedule = build_schedule([window], Hermite(overrun=Fraction("0.01")), period=Fraction(8))
    body = RigidBody.from_rows(INERTIA)
    return TransferProblem.through(schedule, body=body, horizon=horizon, attitude=(1, 1, 1, 1), norm=norm)


def forget() -> None:
    """Drop everything cached, so that each round builds from nothing."""
    propagate.step_functions.cache_clear()
    curvature._step_hessian.cache_clear()


def ours(solver: Any, norm: Norm, horizon: str = "51.22") -> tuple[float, np.ndarray]:
    forget()
    began = time.process_time()
    task = problem(norm, horizon)
    grid = mesh.build_mesh(task.window, [CELLS if shape else 1 for shape in task.window.shapes])
    target = shooting.Shooting(scaling.scale(task), grid, 1)
    answer = solver.solve(target, guess.first_guess(target))
    seconds = time.process_time() - began
    control = np.zeros((grid.size, 3))
    control[grid.open] = answer.flight.control * target.scaled.units.control
    return seconds, control


def edges(task: TransferProblem) -> tuple[list[float], list[bool]]:
    points, opened = [0.0], []
    for piece in task.window.pieces:
        n = CELLS if piece.shape else 1
        points += np.linspace(float(piece.start), float(piece.end), n + 1)[1:].tolist()
        opened += [bool(piece.shape)] * n
    return points, opened


def first_flight(task: TransferProblem) -> tuple[np.ndarray, np.ndarray]:
    """States (edges, 7) and torques (cells, 3), N m, of the start that every tool is given."""
    grid = mesh.build_mesh(task.window, [CELLS if shape else 1 for shape in task.window.shapes])
    target = shooting.Shooting(scaling.scale(task), grid, 1)
    flight, units = target.fly(guess.first_guess(target)), target.scaled.units
    return flight.states * np.r_[np.ones(4), np.full(3, 1 / units.time)], flight.torque * units.torque


def rates(x: Any, torque: Any) -> Any:
    """Euler's equations and quaternion kinematics, typed here as a user of a general tool would."""
    b0, b, w = x[0], x[1:4], x[4:7]
    spin = ca.DM(np.linalg.inv(J)) @ (torque - ca.cross(w, ca.DM(J) @ w))
    return ca.vertcat(-ca.dot(b, w) / 2, (b0 * w + ca.cross(b, w)) / 2, spin)


def opti(norm: Norm) -> tuple[float, np.ndarray]:
    """CasADi's Opti: multiple shooting with the classical Runge-Kutta step, in N mm for scale."""
    began = time.process_time()
    task = problem(norm)
    points, opened = edges(task)
    x, u, h = ca.MX.sym("x", 7), ca.MX.sym("u", 3), ca.MX.sym("h")
    rate = ca.Function("rate", [x, u], [rates(x, u / 1000)])
    steps = {}
    for is_open, count in ((True, 1), (False, GAP_STEPS)):
        end, d = x, h / count
        for _ in range(count):
            k1 = rate(end, u)
            k2 = rate(end + d / 2 * k1, u)
            k3 = rate(end + d / 2 * k2, u)
            k4 = rate(end + d * k3, u)
            end = end + d / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
        steps[is_open] = ca.Function("step", [x, u, h], [end])
    program = ca.Opti()
    p, X, U = program.variable(), program.variable(7, len(opened) + 1), program.variable(3, sum(opened))
    program.subject_to(X[:, 0] == START)
    used = 0
    for k, is_open in enumerate(opened):
        torque = U[:, used] if is_open else ca.DM.zeros(3)
        used += is_open
        program.subject_to(X[:, k + 1] == steps[is_open](X[:, k], torque, points[k + 1] - points[k]))
        if is_open and norm.is_ball:
            program.subject_to(ca.sumsqr(torque) <= p**2)
        elif is_open:
            program.subject_to(program.bounded(-p, torque, p))
    program.subject_to(p >= 0)
    program.subject_to(X[1:, -1] == 0)
    program.minimize(p)
    states, torques = first_flight(task)
    program.set_initial(X, states.T)
    program.set_initial(U, 1000 * torques[np.array(opened)].T)
    program.set_initial(p, 1100 * np.abs(torques).max())
    quiet = {"print_time": False, "expand": OPTI_EXPANDS}
    program.solver("ipopt", quiet, {"print_level": 0, "sb": "yes", "tol": 1e-10})
    found = program.solve().value(U) / 1000
    seconds = time.process_time() - began
    control = np.zeros((len(opened), 3))
    control[np.array(opened)] = found.T
    return seconds, control


def rockit(norm: Norm) -> tuple[float, np.ndarray]:
    """rockit-meco: one stage a window and one a gap, multiple shooting, the peak a constant state."""
    import rockit as rk

    began = time.process_time()
    task = problem(norm)
    program = rk.Ocp()
    stages: list[Any] = []
    states, torques = first_flight(task)
    cell = 0
    for piece in task.window.pieces:
        stage = program.stage(t0=float(piece.start), T=float(piece.length))
        x, p = stage.state(7), stage.state()
        u = stage.control(3) if piece.shape else ca.DM.zeros(3)
        stage.set_der(x, rates(x, u / 1000))
        stage.set_der(p, 0)
        if piece.shape and norm.is_ball:
            stage.subject_to(ca.sumsqr(u) <= p**2)
        elif piece.shape:
            for i in range(3):
                stage.subject_to(-p <= (u[i] <= p))
        if piece.shape:
            stage.subject_to(stage.at_t0(p) >= 0)
        cells, steps = (CELLS, 1) if piece.shape else (1, GAP_STEPS)
        stage.set_initial(x, states[cell : cell + cells + 1].T)
        if piece.shape:
            stage.set_initial(u, 1000 * torques[cell : cell + cells].T)
        stage.set_initial(p, 1100 * np.abs(torques).max())
        cell += cells
        stage.method(rk.MultipleShooting(N=cells, M=steps, intg="rk"))
        if stages:
            last, y, q, _ = stages[-1]
            program.subject_to(last.at_tf(y) == stage.at_t0(x))
            program.subject_to(last.at_tf(q) == stage.at_t0(p))
        stages.append((stage, x, p, u if piece.shape else None))
    first, x, p, _ = stages[0]
    first.subject_to(first.at_t0(x) == START)
    last, y, q, _ = stages[-1]
    last.subject_to(last.at_tf(y[1:]) == 0)
    program.add_objective(last.at_tf(q))
    quiet = {"print_time": False, "expand": ROCKIT_EXPANDS}
    program.solver("ipopt", {**quiet, "ipopt": {"print_level": 0, "sb": "yes", "tol": 1e-10}})
    with contextlib.redirect_stdout(io.StringIO()):
        solution = program.solve()
    parts = []
    for stage, _, _, u in stages:
        parts.append(
            np.zeros((1, 3)) if u is None else solution(stage).sample(u, grid="control")[1][:-1] / 1000
        )
    seconds = time.process_time() - began
    return seconds, np.vstack(parts)


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    tools: dict[str, Callable[[Norm], tuple[float, np.ndarray]]] = {
        "intermit, convex programs": lambda norm: ours(SequentialConvex(), norm),
        "intermit, nonlinear program": lambda norm: ours(NonlinearProgram(), norm),
        "CasADi Opti": opti,
        "rockit-meco": rockit,
    }
    if importlib.util.find_spec("rockit") is None:
        del tools["rockit-meco"]
        print("rockit-meco: skipped, it is not installed\n")
    print(f"{'':30} {'norm':18} {'cpu s':>8} {'peak, N m':>13} {'end error':>10}")
    for norm in (LARGEST_COMPONENT, EUCLIDEAN):
        times: dict[str, list[float]] = {name: [] for name in tools}
        controls: dict[str, np.ndarray] = {}
        for _ in range(rounds):
            for name, tool in tools.items():
                seconds, controls[name] = tool(norm)
                times[name].append(seconds)
        task = problem(norm)
        points, opened = edges(task)
        profile = np.array(opened, dtype=float)[:, None]
        for name in tools:
            history = TorqueHistory(np.array(points), profile, controls[name], norm)
            flown = replay(task, history)
            error = max(flown.terminal.attitude_error, flown.terminal.rate_error * float(task.horizon))
            median = statistics.median(times[name])
            print(f"{name:30} {norm.name:18} {median:8.3f} {history.peak:13.9f} {error:10.1e}")
        for other in list(tools)[2:]:
            ratios = [statistics.median(times[other]) / statistics.median(times[n]) for n in list(tools)[:2]]
            print(f"{other} takes {ratios[0]:.1f} and {ratios[1]:.1f} times as long")
        print()


if __name__ == "__main__":
    main()
