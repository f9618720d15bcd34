"""Gradient search for the least margin of V', from the worst samples and from copies of them near rest."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, final

import numpy as np

from ...models.types import Array
from .domain import SampledDomain
from .function import DerivativeFunction

Margin = Literal["rate", "bound"]

BARRIER = 1e-12
"""Added to the margin's numerator in the search, in units of the largest rate times a W half way out, so that
it keeps off the equilibrium, where the margin is 0/0: 1 - b0 still has ten digits there."""
SHRINK = 0.1
"""Near the equilibrium V' and W are both quadratic: a worst direction found far away is tried there too."""
ITERATIONS = 100


@final
@dataclass(frozen=True)
class Refinement:
    """The least margin found, 1/s, its coordinates (b0..b3, Omega, controller, g, g') and the effort."""

    value: float
    coordinates: Array
    evaluations: int


def refine(
    check: DerivativeFunction,
    domain: SampledDomain,
    uniform: tuple[Array, Array, Array],
    starts: Array,
    margin: Margin,
) -> Refinement:
    """Minimise -V'/W, or (bound - V')/W, over the domain.

    Parameters
    ----------
    check : DerivativeFunction
        V' and what it is held against.
    domain : SampledDomain
        Box of states the search stays in.
    uniform : tuple[Array, Array, Array]
        Parameters, body and extra arguments of `check.function`.
    starts : Array
        (m, n) coordinates; they must lie in the domain.
    margin : Margin
        Which of the two is minimised.
    """
    from scipy.optimize import minimize

    low, high = domain.bounds()
    largest = np.maximum(np.abs(low), np.abs(high))
    sizes = np.r_[np.ones(4), np.where(largest > 0, largest, 1.0)]  # no coordinate has a unit in the search
    objective = _Objective(check, margin, uniform, sizes)
    limits = [(-2.0, 2.0)] * 4 + list(
        zip((low / sizes[4:]).tolist(), (high / sizes[4:]).tolist(), strict=True)
    )
    best, where, evaluations = np.inf, starts[0] / sizes, 0
    for start in np.vstack([starts, _shrunk(starts)]) / sizes:
        found = minimize(
            objective,
            start,
            jac=True,
            method="L-BFGS-B",
            bounds=limits,
            options={"maxiter": ITERATIONS},
        )
        evaluations += int(found.nfev)
        for point in (_unit(start), _unit(found.x)):
            value, _ = objective(point)
            if value < best:
                best, where = value, point
    return Refinement(objective.margin(where), where * sizes, evaluations)


def _shrunk(starts: Array) -> Array:
    copies = starts.copy()
    copies[:, 1:7] *= SHRINK
    copies[:, 0] = np.sqrt(1 - np.sum(copies[:, 1:4] ** 2, axis=1))
    return copies


def _unit(point: Array) -> Array:
    unit = np.array(point, dtype=float)
    unit[:4] /= np.linalg.norm(unit[:4])
    return unit


@final
class _Objective:
    """The margin with its barrier and its gradient; attitudes are normalised.

    CasADi reads and writes arrays of this object: converting arguments takes ten times the arithmetic.
    """

    def __init__(
        self, check: DerivativeFunction, margin: Margin, uniform: tuple[Array, Array, Array], sizes: Array
    ) -> None:
        import casadi as ca

        function = check.function
        point = ca.SX.sym("z", function.size1_in(0))
        others = [ca.SX.sym(f"u{i}", function.size1_in(i)) for i in (1, 2, 3)]
        state = ca.vertcat(point[:4] / ca.norm_2(point[:4]), point[4:] * ca.DM(sizes[4:]))
        rate, storage, bound, *_ = function(state, *others)
        gap = -rate if margin == "rate" else bound - rate
        far = np.r_[np.full(4, 0.5), sizes[4:] / 2]
        weight, largest = abs(float(function(far, *uniform)[1])) or 1.0, float(sizes[4])
        value = (gap + BARRIER * weight * largest) / storage / largest
        results = [value, ca.densify(ca.gradient(value, point)), gap / storage]
        self._function = ca.Function("objective", [point, *others], results)
        self._point = np.empty(function.size1_in(0))
        self._results = [np.empty(1), np.empty(self._point.size), np.empty(1)]
        self._uniform = [np.array(row, dtype=float) for row in uniform]
        buffer: Any
        buffer, self._evaluate = self._function.buffer()
        for i, values in enumerate([self._point, *self._uniform]):
            buffer.set_arg(i, values.data)
        for i, values in enumerate(self._results):
            buffer.set_res(i, values.data)
        self._kept = buffer  # CasADi keeps no reference to it

    def __call__(self, point: Array) -> tuple[float, Array]:
        """Value and gradient."""
        self._point[:] = point
        self._evaluate()
        return float(self._results[0][0]), self._results[1].copy()

    def margin(self, point: Array) -> float:
        """The margin itself."""
        self(point)
        return float(self._results[2][0])
