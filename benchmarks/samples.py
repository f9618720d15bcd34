"""The sample check: V, V' and the paper's bound at many random states.

    python benchmarks/samples.py [samples] [rounds]

All contenders get the same states and the same formulas (the hand-written one types them again).
"""

from __future__ import annotations

import statistics
import sys
import time
from typing import Any

import casadi as ca
import numpy as np
from common import J1, LAW, Contender, Missing, machine, race, table
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.lowering import heyoka_available, sample_function, shared, walk
from intermit.models.storage import weighted_storage

TARGET = 1 / 0.149646
LEAST = float(J1.principal_inertias[0])
LOOP = close_loop(LAW)
PARAMETERS, BODY = LOOP.parameter_values(), body_values(J1)
CONSTANTS = np.array([1.0, TARGET, LEAST])
UNIFORM = (1, 2, 3)


def check_function() -> Any:
    """((state, g, g'), parameters, body, (a, k*, Jmin)) -> V, V', the paper's bound."""
    storage, constants = weighted_storage(LOOP), ca.SX.sym("constants", 3)
    a, target, least = constants[0], constants[1], constants[2]
    b0, R, lam = LOOP.plant.b0, LOOP.controller_states["R"], LOOP.parameter_symbols["lambda"]
    Omega = LOOP.augmented_rate
    bound = -(lam * least - a / 2) * R * ca.sumsqr(Omega) - 2 * a * (lam - (1 + b0) / 4) * R * (1 - b0)
    outputs = ca.substitute(
        [storage.value, storage.derivative, bound], [storage.weight, storage.gain_target], [a, target]
    )
    coordinates = ca.vertcat(LOOP.state, LOOP.time)
    return ca.Function("check", [coordinates, LOOP.parameters, LOOP.body, constants], outputs)


def states(count: int) -> np.ndarray:
    """Random states with g and g', (11, N)."""
    rng = np.random.default_rng(1)
    x = rng.normal(size=(9, count))
    x[:4] /= np.linalg.norm(x[:4], axis=0)
    x[7], x[8] = rng.uniform(0.15, 2, count), rng.uniform(0, 6, count)
    return np.vstack([x, rng.uniform(0, 1, count), rng.uniform(-1.9, 1.9, count)])


def by_hand(x: np.ndarray) -> list[np.ndarray]:
    """The same in numpy, as one would write it: whole (3, N) arrays."""
    J, (lam, gamma) = J1.inertia, PARAMETERS[:1].tolist() + PARAMETERS[1:2].tolist()
    b0, b, w, R, k, (g, gd) = x[0], x[1:4], x[4:7], x[7], x[8], x[9:]
    Omega = w + 2 * g**2 * k * b
    JO, Jw, Jb = J @ Omega, J @ w, J @ b
    energy, away = np.sum(Omega * JO, axis=0), 1 - b0
    bd = 0.5 * (b0 * w + np.cross(b, w, axis=0))
    b0d = -0.5 * np.sum(b * w, axis=0)
    Rd = -lam * R + g**2 * (1 + b0)
    kd = gamma * R * g**2 * ((1 + b0) * energy + 2 * np.sum(b * b, axis=0))
    u = -2 * g * k * np.cross(b, Jw, axis=0) - 4 * gd * k * Jb - 2 * g * kd * Jb
    u = u - 2 * g * k * (J @ bd) - g / 2 * k * (1 + b0) * JO
    shift = 2 * g * gd * k * b + g**2 * (kd * b + k * bd)
    JOd = -np.cross(w, Jw, axis=0) + g * u + 2 * (J @ shift)
    V = R * (2 * away + energy) + (k - TARGET) ** 2 / (2 * gamma)
    Vd = Rd * (2 * away + energy) + R * (-2 * b0d + 2 * np.sum(Omega * JOd, axis=0))
    Vd = Vd + (k - TARGET) * kd / gamma
    bound = -(lam * LEAST - 0.5) * R * np.sum(Omega * Omega, axis=0) - 2 * (lam - (1 + b0) / 4) * R * away
    return [V, Vd, bound]


def contenders(count: int) -> tuple[list[Contender], Any]:
    function, x = check_function(), states(count)
    slow = min(count, 1 << 16)

    def columns() -> Any:
        return lambda: [np.asarray(r) for r in function(x[:, :slow], PARAMETERS, BODY, CONSTANTS)]

    def mapped() -> Any:
        size = min(slow, 4096)
        many = function.map("many", "serial", size, [1, 2, 3], [])
        buffer, evaluate = many.buffer()
        xs = np.empty((size, 11))
        results = [np.empty(size) for _ in range(3)]
        inputs = (xs, PARAMETERS, BODY, CONSTANTS)
        for i, values in enumerate(inputs):
            buffer.set_arg(i, values.data)
        for i, values in enumerate(results):
            buffer.set_res(i, values.data)

        def run() -> list[np.ndarray]:
            out = np.empty((3, slow))
            for start in range(0, slow, size):
                xs[:] = x[:, start : start + size].T
                evaluate()
                out[:, start : start + size] = results
            return list(out)

        run.kept = (buffer, many)  # CasADi keeps no reference to either
        return run

    def hand(block: int | None) -> Any:
        def run() -> list[np.ndarray]:
            if block is None:
                return by_hand(x)
            out = np.empty((3, count))
            for start in range(0, count, block):
                out[:, start : start + block] = by_hand(x[:, start : start + block])
            return list(out)

        return run

    def lowered(backend: Any) -> Any:
        if backend == "fast" and not heyoka_available():
            raise Missing("heyoka")
        many = sample_function(shared(walk(function)), uniform=UNIFORM, backend=backend)
        results = many.allocate(count)

        def run() -> list[np.ndarray]:
            many.into((x, PARAMETERS, BODY, CONSTANTS), results)
            return results

        return run

    share = slow / count
    return [
        Contender("CasADi function on columns", columns, share),
        Contender("CasADi map, buffers", mapped, share),
        Contender("numpy by hand, whole arrays", lambda: hand(None)),
        Contender("numpy by hand, blocks of 2048", lambda: hand(2048)),
        Contender("intermit, default", lambda: lowered("default")),
        Contender("intermit, fast (heyoka)", lambda: lowered("fast")),
    ], function


def difference(found: Any, truth: list[np.ndarray]) -> str:
    """Largest difference relative to the value, values below a thousandth of the largest counting as that."""
    worst, same = 0.0, True
    for f, r in zip(found, truth, strict=True):
        a, b = np.ravel(f)[: r.size], np.ravel(r)[: np.size(f)]
        same = same and np.array_equal(a, b)
        worst = max(worst, float(np.max(np.abs(a - b) / np.maximum(np.abs(b), 1e-3 * np.abs(b).max()))))
    return "bit-identical" if same else f"{worst:.0e}"


def derivative_check(count: int) -> Any:
    """The check itself, sampling, reductions and search included."""
    from fractions import Fraction as F

    from intermit.verify.sampling import SampledDomain, Sampling, derivative_function, sample_derivative

    domain = SampledDomain(
        rate=F(1), controller=((F("0.15"), F(2)), (F(0), F(6))), names=("R", "k"), gain=F(1), gain_rate=F(2)
    )
    check = derivative_function(LOOP)
    return sample_derivative(check, J1, domain, gain_target=F(TARGET), sampling=Sampling(count=count))


def whole_check(count: int, rounds: int) -> list[list[str]]:
    """Time of the whole check: the first call, with what it imports, and the median of later ones."""
    times = []
    for _ in range(rounds + 1):
        began = time.perf_counter()
        derivative_check(count)
        times.append(time.perf_counter() - began)
    first, later = times[0], statistics.median(times[1:])
    return [
        [what, f"{count / seconds / 1e6:.2f}", f"{seconds:.2f} s"]
        for what, seconds in (
            ("first call", first),
            ("Sobol points, six quantities, tallies, search", later),
        )
    ]


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1 << 20
    rounds = int(sys.argv[2]) if len(sys.argv) > 2 else 5
    many, _ = contenders(count)
    times, missing = race(many, rounds)
    base = times[0]
    truth = [np.ravel(r) for r in base.answer]
    rows = [
        [
            t.name,
            f"{count / t.median / 1e6:.2f}",
            f"{base.median / t.median:.1f}",
            difference(t.answer, truth),
            f"{t.setup:.2f}",
        ]
        for t in times
    ]
    table(
        f"Sample check: V, V' and a bound at {count} states, one thread",
        ["way", "million samples/s", "ratio", "against CasADi", "set-up, s"],
        rows,
        [machine(), f"median of {rounds} rounds in turn; slow ways do a share of the work", *missing],
    )
    table("The whole derivative check", ["what", "million samples/s", "time"], whole_check(count, rounds))


if __name__ == "__main__":
    main()
