"""Scrambled Sobol points through V' and its stated bound, streamed, with the worst of them kept.

What comes out is evidence of kind SAMPLES: it can find a mistake and never proves its absence.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.closed_loop import body_values
from ...models.lowering import ArrayFunction, shared, walk
from ...models.rigid_body import RigidBody
from ...models.types import Array
from .domain import SampledDomain
from .function import DerivativeFunction
from .search import Refinement, refine
from .sobol import BITS, PRIMITIVE, SobolRows

Progress = Callable[[float], None]

BLOCK = 1 << 14
"""Points drawn at a time: memory does not grow with their number, and a block stays in the cache."""
KEPT = 8
"""Worst samples from which the gradient search starts."""
BINS = 80
ROUNDING = 1e-12
"""Relative to the terms that cancel in V' (some hundred operations of 1e-16): below it lies rounding."""


@final
@dataclass(frozen=True, kw_only=True)
class Sampling:
    """How to sample: `count` points of the scrambled Sobol sequence of that `seed`, then a search."""

    count: int = 2**20
    seed: int = 1

    def __post_init__(self) -> None:
        if self.count < 1 or self.seed < 0:
            raise ValueError(f"expected count >= 1 and seed >= 0, received {self.count} and {self.seed}")
        if self.count > 1 << BITS:
            raise ValueError(f"the Sobol sequence has 2^{BITS} distinct points, {self.count} were asked for")


@final
@dataclass(frozen=True)
class DerivativeSamples:
    """What sampling found.

    Attributes
    ----------
    violations, bound_violations : samples with V' > 0, and with V' above the paper's bound, beyond rounding
    worst : least -V'/W over samples and search, 1/s, with its coordinates
    worst_bound : least (bound - V')/W, 1/s, with its coordinates; None outside the family
    sampled_worst : least -V'/W over the samples alone, 1/s
    candidates : (m, n) coordinates in which to look for a witness: the search's end, then the worst samples
    identity_residual : largest |V' by differentiation - V' as stated| over the terms' size; None outside
        the family
    identity_state : where
    edges, counts : histogram of -V'/W over the samples; the end bins hold what lies beyond
    search_evaluations : gradient evaluations of the search
    """

    sampling: Sampling
    domain: SampledDomain
    violations: int
    bound_violations: int
    worst: Refinement
    worst_bound: Refinement | None
    sampled_worst: float
    candidates: Array
    identity_residual: float | None
    identity_state: Array
    edges: Array
    counts: Array
    search_evaluations: int


def sample_derivative(
    check: DerivativeFunction,
    body: RigidBody,
    domain: SampledDomain,
    *,
    weight: Fraction = Fraction(1),
    gain_target: Fraction = Fraction(0),
    sampling: Sampling | None = None,
    progress: Progress | None = None,
) -> DerivativeSamples:
    """Sample V' over a domain and search on from the worst samples.

    Parameters
    ----------
    check : DerivativeFunction
        V' and what it is held against.
    body : RigidBody
        The body.
    domain : SampledDomain
        Box of states that is sampled.
    weight : Fraction
        a, kg m^2/s^2.
    gain_target : Fraction
        k* = 1/R_min, 1/s (laws with a gain state).
    sampling : Sampling, optional
        Number of samples, seed and search; its defaults without one.
    progress : Progress, optional
        Called with the fraction done.
    """
    sampling = sampling if sampling is not None else Sampling()
    uniform = _uniform(check, body, weight, gain_target)
    function = ArrayFunction(shared(walk(check.function)), uniform=(1, 2, 3))
    tally = _Tally(check.in_family, _edges(check))
    room: list[Array] = []
    for coordinates, fraction in _blocks(domain, sampling):
        if not room or room[0].shape[1] != coordinates.shape[1]:
            room = function.allocate(coordinates.shape[1])
        function.into((coordinates, *uniform), room)
        tally.add(coordinates, [row[0] for row in room])
        if progress is not None:
            progress(fraction)
    worst = refine(check, domain, uniform, tally.worst.starts(), "rate")
    worst_bound = (
        refine(check, domain, uniform, tally.worst_bound.starts(), "bound") if check.in_family else None
    )
    return DerivativeSamples(
        sampling=sampling,
        domain=domain,
        violations=tally.violations,
        bound_violations=tally.bound_violations,
        worst=worst,
        worst_bound=worst_bound,
        sampled_worst=tally.worst.least,
        candidates=np.vstack([worst.coordinates, tally.worst.starts()]),
        identity_residual=tally.residual if check.in_family else None,
        identity_state=tally.residual_state,
        edges=tally.edges,
        counts=tally.counts,
        search_evaluations=worst.evaluations + (worst_bound.evaluations if worst_bound else 0),
    )


def _uniform(
    check: DerivativeFunction, body: RigidBody, weight: Fraction, target: Fraction
) -> tuple[Array, Array, Array]:
    extra = np.array([float(weight), float(target), body.principal_inertias[0]])
    return check.loop.parameter_values(), body_values(body), extra


def _edges(check: DerivativeFunction) -> Array:
    """Bins of -V'/W around the scale on which it varies, 1/s."""
    scale = float(check.loop.law.parameters.get("lambda", Fraction(1)))
    return np.linspace(-2 * scale, 6 * scale, BINS + 1)


def _blocks(domain: SampledDomain, sampling: Sampling) -> Iterator[tuple[Array, float]]:
    """Coordinates of the points, block by block, and the fraction drawn with each; a block is overwritten
    by the next.
    """
    # Whole powers of two keep the sequence balanced; what is drawn too many is left out.
    size = min(BLOCK, 1 << (sampling.count - 1).bit_length())
    out = np.empty((domain.dimension + 1, size))
    for drawn, cube in zip(range(0, sampling.count, size), _cubes(domain, sampling, size), strict=False):
        kept = out[:, : sampling.count - drawn]
        domain.fill(cube[:, : kept.shape[1]], kept)
        yield kept, min(drawn + size, sampling.count) / sampling.count


def _cubes(domain: SampledDomain, sampling: Sampling, size: int) -> Iterator[Array]:
    """Rows of unit-cube coordinates, (dimension, size)."""
    if domain.dimension <= len(PRIMITIVE):
        yield from SobolRows(domain.dimension, seed=sampling.seed, block=size).blocks()
        return
    from scipy.stats import qmc  # has direction numbers for thousands of coordinates

    engine = qmc.Sobol(domain.dimension, scramble=True, rng=np.random.default_rng(sampling.seed))
    while True:
        yield engine.random(size).T


@final
class _Least:
    """The few samples with the least values of a margin."""

    def __init__(self) -> None:
        self.values, self.points = np.empty(0), np.empty((0, 0))

    def add(self, values: Array, coordinates: Array) -> None:
        if len(self.values) == KEPT:  # a block rarely holds anything among the least of all before it
            kept = np.flatnonzero(values < self.values[-1])
            if not kept.size:
                return
        else:
            kept = np.arange(len(values))
        if len(kept) > KEPT:
            kept = kept[np.argpartition(values[kept], KEPT)[:KEPT]]
        points = coordinates[:, kept].T
        values = np.append(self.values, values[kept])
        if self.values.size:
            points = np.vstack([self.points, points])
        order = np.argsort(values, kind="stable")[:KEPT]
        self.values, self.points = values[order], points[order]

    @property
    def least(self) -> float:
        return float(self.values[0])

    def starts(self) -> Array:
        """Coordinates of the kept samples, worst first, (KEPT, n)."""
        return self.points


@final
class _Tally:
    """Reduces each block to counts, the worst points and a histogram."""

    def __init__(self, in_family: bool, edges: Array) -> None:
        self.in_family, self.edges = in_family, edges
        self.worst, self.worst_bound = _Least(), _Least()
        self.violations = self.bound_violations = 0
        self.residual, self.residual_state = 0.0, np.empty(0)
        self.counts = np.zeros(len(edges) - 1)

    def add(self, coordinates: Array, results: list[Array]) -> None:
        """Take a block in; its results are overwritten."""
        rate, storage, bound, by_differentiation, stated, scale = results
        rounding = ROUNDING * scale
        self.violations += int(np.count_nonzero(rate > rounding))
        positive = storage > 0
        with np.errstate(all="ignore"):
            margin = rate / storage
        np.negative(margin, out=margin)
        if not positive.all():
            margin[~positive] = np.inf
        self.worst.add(margin, coordinates)
        if self.in_family:
            residuals = np.subtract(by_differentiation, stated, out=by_differentiation)
            np.divide(np.abs(residuals, out=residuals), scale, out=residuals)
            largest = int(np.argmax(residuals))
            if not self.residual_state.size or residuals[largest] > self.residual:
                self.residual, self.residual_state = float(residuals[largest]), coordinates[:, largest].copy()
            rounding += bound
            self.bound_violations += int(np.count_nonzero(rate > rounding))
            bound -= rate
            self.worst_bound.add(np.divide(bound, storage, out=bound), coordinates)
        first, last = self.edges[0], self.edges[-1]
        np.clip(margin, first, np.nextafter(last, 0), out=margin)
        self.counts += np.histogram(margin, len(self.counts), (first, last))[0]
