"""Many runs side by side, each with its own step size: Dormand-Prince 8(5,3), vectorised.

A stack of runs under one step size and one error norm is only as good as its mean, and as slow
as its worst run. Here every run keeps its own time, step and error norm; runs that reach the end
leave the stack. Coefficients, error estimate and interpolant are those of scipy's
DOP853 (Hairer, Norsett & Wanner, Solving Ordinary Differential Equations I).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, final

import numpy as np

from ..types import Array
from .step import Index, Mask, Observer, Step, nested

STAGES = 12
SAFETY, MIN_FACTOR, MAX_FACTOR = 0.85, 0.2, 10.0
ERROR_EXPONENT = -1 / 8


class Field(Protocol):
    """Right-hand side of the runs still in the stack."""

    def __call__(self, t: Array, y: Array, out: Array) -> None:
        """Write x' (n, m) at times t (m,) and states y (n, m) into `out`."""

    def keep(self, kept: Mask) -> None:
        """Drop the runs that have left the stack."""


@final
@dataclass(frozen=True)
class Tolerances:
    """Local tolerances of every run: error norm < 1 with scale atol + rtol |y|.

    The defaults keep the paper's scenario within 1e-8 everywhere, between steps too, where the
    interpolant (of order 7, not error controlled) is some hundred times worse than the steps.
    `phase_evaluations`: right-hand sides a run may spend on one phase before it counts as stopped;
    a search sets it, so that one stiff candidate cannot hold up a generation.
    """

    rtol: float = 2e-11
    atol: float = 2e-13
    phase_evaluations: int | None = None

    def __post_init__(self) -> None:
        if self.phase_evaluations is not None and self.phase_evaluations < 100:
            raise ValueError(f"phase_evaluations must be at least 100, received {self.phase_evaluations}")
        if not (0 < self.rtol < 1 and self.atol > 0):
            raise ValueError(f"tolerances must be positive: rtol {self.rtol}, atol {self.atol}")


@final
class _Tableau:
    """scipy's coefficients of the method, loaded when first used."""

    @cached_property
    def a(self) -> list[Array]:
        """Weights of each stage; the 13th row gives the new state, the last three the interpolant's."""
        from scipy.integrate import DOP853

        rows = [*DOP853.A, DOP853.B, *DOP853.A_EXTRA]
        return [np.ascontiguousarray(row[:s], dtype=float) for s, row in enumerate(rows)]

    @cached_property
    def c(self) -> Array:
        """Fraction of the step at which each stage is evaluated."""
        from scipy.integrate import DOP853

        return np.concatenate([DOP853.C, [1.0], DOP853.C_EXTRA])

    @cached_property
    def errors(self) -> Array:
        """Weights of the fifth- and third-order error estimates."""
        from scipy.integrate import DOP853

        return np.ascontiguousarray(np.stack([DOP853.E5, DOP853.E3]))

    @cached_property
    def interpolant(self) -> Array:
        """Weights of the interpolant's last four coefficients."""
        from scipy.integrate import DOP853

        return np.ascontiguousarray(DOP853.D)


TABLEAU = _Tableau()


@final
class Stack:
    """Runs of one phase that have not reached its end yet.

    Parameters
    ----------
    field : Field
        Right-hand side.
    runs : (m,) numbers of the runs.
    y : (n, m) states at `start`.
    start, end : the phase, s.
    tolerances : Tolerances
        Of every run.
    atol : (n, m), optional
        Absolute tolerances of each state of each run, in place of the common one.
    """

    def __init__(
        self,
        field: Field,
        runs: Index,
        y: Array,
        start: float,
        end: float,
        tolerances: Tolerances,
        atol: Array | None = None,
    ) -> None:
        self.field, self.runs, self.y, self.end, self.tolerances = field, runs, y, end, tolerances
        self._atol = np.full(y.shape, tolerances.atol) if atol is None else atol
        self.t = np.full(runs.size, start)
        self.f = np.empty_like(y)
        self.evaluations = np.zeros(runs.size, dtype=np.int64)
        self._workspace = np.empty(16 * y.size)
        self._rejected = np.zeros(runs.size, dtype=bool)
        self._evaluate(self.t, self.y, self.f)
        self.h = self._first_step(end - start)

    def _evaluate(self, t: Array, y: Array, out: Array) -> None:
        self.field(t, y, out)
        self.evaluations += 1

    def _first_step(self, longest: float) -> Array:
        """First steps (Hairer, Norsett & Wanner, II.4)."""
        scale = self._atol + np.abs(self.y) * self.tolerances.rtol
        d0, d1 = _norm(self.y / scale), _norm(self.f / scale)
        h0 = np.where((d0 < 1e-5) | (d1 < 1e-5), 1e-6, 0.01 * d0 / np.where(d1 > 0, d1, 1.0))
        h0 = np.minimum(np.where(np.isfinite(h0), h0, 1e-6), longest)
        f1 = np.empty_like(self.f)
        self._evaluate(self.t + h0, self.y + h0 * self.f, f1)
        d2 = _norm((f1 - self.f) / scale) / h0
        largest = np.maximum(d1, d2)
        flat = largest <= 1e-15
        h1 = np.where(flat, np.maximum(1e-6, h0 * 1e-3), (0.01 / np.where(flat, 1.0, largest)) ** (1 / 8))
        return np.asarray(np.minimum(np.minimum(100 * h0, np.where(np.isfinite(h1), h1, h0)), longest))

    def advance(self, observers: tuple[Observer, ...]) -> None:
        """One trial step of every run; accepted ones are shown to the observers."""
        y, t, n = self.y, self.t, self.y.shape[0]
        left = self.end - t
        h = np.where(self.h >= left, left, np.where(self.h > 0.5 * left, 0.5 * left, self.h))
        K = self._workspace[: 16 * y.size].reshape(16, n, y.shape[1])
        flat = K.reshape(16, y.size)
        K[0] = self.f
        for s in range(1, STAGES):
            stage = np.dot(TABLEAU.a[s], flat[:s]).reshape(y.shape)
            stage *= h
            stage += y
            self._evaluate(t + TABLEAU.c[s] * h, stage, K[s])
        new = np.dot(TABLEAU.a[STAGES], flat[:STAGES]).reshape(y.shape)
        new *= h
        new += y
        arrived = np.where(h >= left, self.end, t + h)
        self._evaluate(arrived, new, K[STAGES])
        error = self._error(flat[: STAGES + 1], new, h)
        accepted = error < 1
        if observers and accepted.any():
            step = self._interpolate(K, new, h, arrived, accepted)
            for observer in observers:
                observer.see(step)
        self._accept(accepted, error, h, arrived, new, K[STAGES])

    def _error(self, flat: Array, new: Array, h: Array) -> Array:
        """Error norm of each run, inf where a state is no longer a number."""
        scale = self._atol + np.maximum(np.abs(self.y), np.abs(new)) * self.tolerances.rtol
        estimates = np.dot(TABLEAU.errors, flat).reshape(2, *new.shape) / scale
        fifth, third = np.einsum("enm,enm->em", estimates, estimates)
        denominator = np.sqrt((fifth + 0.01 * third) * new.shape[0])
        error = np.where(denominator > 0, h * fifth / np.where(denominator > 0, denominator, 1.0), 0.0)
        return np.where(np.isfinite(error), error, np.inf)

    def _accept(
        self, accepted: Mask, error: Array, h: Array, arrived: Array, new: Array, f_new: Array
    ) -> None:
        factor = SAFETY * np.maximum(error, 1e-30) ** ERROR_EXPONENT
        largest = np.where(accepted & ~self._rejected, MAX_FACTOR, 1.0)
        self.h = h * np.clip(factor, MIN_FACTOR, largest)
        self._rejected = ~accepted
        if accepted.all():
            self.y, self.f, self.t = new, f_new.copy(), arrived
            return
        self.y = np.where(accepted, new, self.y)
        self.f = np.where(accepted, f_new, self.f)
        self.t = np.where(accepted, arrived, self.t)

    def _interpolate(self, K: Array, new: Array, h: Array, arrived: Array, accepted: Mask) -> Step:
        y, t, flat = self.y, self.t, K.reshape(16, -1)
        for s in range(STAGES + 1, 16):
            stage = np.dot(TABLEAU.a[s], flat[:s]).reshape(y.shape)
            stage *= h
            stage += y
            self._evaluate(t + TABLEAU.c[s] * h, stage, K[s])
        F = np.empty((7, *y.shape))
        np.subtract(new, y, out=F[0])
        np.subtract(h * K[0], F[0], out=F[1])
        np.subtract(2 * F[0], h * (K[STAGES] + K[0]), out=F[2])
        F[3:] = np.dot(TABLEAU.interpolant, flat).reshape(4, *y.shape)
        F[3:] *= h
        coefficients = np.ascontiguousarray(F.transpose(2, 0, 1))
        step = Step(self.runs, t, arrived, h, np.ascontiguousarray(y.T), coefficients, nested)
        return step if accepted.all() else step.only(accepted)

    @property
    def finished(self) -> Mask:
        """Which runs have reached the end."""
        return np.asarray(self.t >= self.end)

    @property
    def stuck(self) -> Mask:
        """Which runs cannot go on: step shrunk to the spacing of times, or evaluations spent."""
        stuck = self.h < 10 * np.spacing(self.t)
        if self.tolerances.phase_evaluations is not None:
            stuck |= self.evaluations >= self.tolerances.phase_evaluations
        return np.asarray(stuck)

    def keep(self, kept: Mask) -> None:
        """Drop the other runs from the stack."""
        self.runs, self.t, self.h = self.runs[kept], self.t[kept], self.h[kept]
        self.y, self.f, self._atol = self.y[:, kept], self.f[:, kept], self._atol[:, kept]
        self._rejected, self.evaluations = self._rejected[kept], self.evaluations[kept]
        self.field.keep(kept)


def _norm(x: Array) -> Array:
    """Root mean square over the states of each run."""
    return np.asarray(np.sqrt(np.einsum("nm,nm->m", x, x) / x.shape[0]))
