"""One accepted step of many runs, and what reads it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import final

import numpy as np
from numpy.typing import NDArray

from ..types import Array

Mask = NDArray[np.bool_]
Index = NDArray[np.intp]
Basis = Callable[[Array, int], Array]
"""(x of any shape, q) -> values of q basis functions, in a last axis; all vanish at x = 0."""


class Observer(ABC):
    """Something that reads accepted steps as they are made."""

    def enter(self, phase: int) -> None:  # noqa: B027 - most observers do not care
        """Note the number of the phase that begins."""

    @abstractmethod
    def see(self, step: Step) -> None:
        """Read one accepted step of some runs."""


@final
@dataclass(frozen=True, eq=False)
class Step:
    """One accepted step of m runs.

    Attributes
    ----------
    runs : (m,) numbers of the runs
    start, end, length : (m,), s
    states : (m, n) at the start
    coefficients : (m, q, n): x(t) = states + sum_q basis_q((t - start)/length) coefficients_q
    basis : the q basis functions
    decay : (m, c), 1/s, where the last c states are multiplied by exp(-decay (t - since)); None without
    since : s
    """

    runs: Index
    start: Array
    end: Array
    length: Array
    states: Array
    coefficients: Array
    basis: Basis
    decay: Array | None = None
    since: float = 0.0

    def at(self, x: Array) -> Array:
        """States (m, p, n) at the fractions x (m, p) or (p,) of the steps."""
        fractions = np.broadcast_to(x, (self.runs.size, x.shape[-1]))
        values: Array = np.matmul(self.basis(fractions, self.coefficients.shape[1]), self.coefficients)
        values += self.states[:, None, :]
        if self.decay is not None:
            passed = self.start[:, None] - self.since + fractions * self.length[:, None]
            values[:, :, -self.decay.shape[1] :] *= np.exp(-self.decay[:, None, :] * passed[:, :, None])
        return values

    def only(self, chosen: Mask | Index) -> Step:
        """The same step of some of the runs."""
        return replace(
            self,
            runs=self.runs[chosen],
            start=self.start[chosen],
            end=self.end[chosen],
            length=self.length[chosen],
            states=self.states[chosen],
            coefficients=self.coefficients[chosen],
            decay=None if self.decay is None else self.decay[chosen],
        )


def nested(x: Array, count: int) -> Array:
    """DOP853's basis: x, x(1-x), x^2(1-x), x^2(1-x)^2, ..."""
    basis = np.empty((*x.shape, count))
    rest = 1 - x
    basis[..., 0] = x
    for i in range(1, count):
        np.multiply(basis[..., i - 1], rest if i % 2 else x, out=basis[..., i])
    return basis


def powers(x: Array, count: int) -> Array:
    """Taylor's basis: x, x^2, x^3, ..."""
    basis = np.empty((*x.shape, count))
    basis[..., 0] = x
    for i in range(1, count):
        np.multiply(basis[..., i - 1], x, out=basis[..., i])
    return basis
