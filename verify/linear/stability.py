"""Stability of the linear plant x' = (A - g(t) B K) x through periodic windows, PROVED or REFUTED.

The monodromy matrix M is enclosed in rationals; a rational P with M'PM < r^2 P, P > 0 proves that
every Floquet multiplier is below r in modulus, one with M'PM > r^2 P and x'Px > 0 that some
multiplier is above r. Both are checked by the stand-alone checker; floats only propose P.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import ceil
from typing import Any, final

import numpy as np

from ...models.linear import LinearPlant
from ...models.schedule.piecewise import Piece
from ...models.types import Array
from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..claim_table import CLAIM_KEYS, stated
from ..exact.matrix import Matrix, identity, is_positive_definite, of, rows
from ..exact.rational import rational
from ..exact.rational_quantity import exponential_quantity, rational_quantity
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness
from .exact import data_of, falling_function, growing_part, plant_data
from .monodromy import Enclosed, monodromy, norm

BACKING_OFF = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Relative distances from the computed spectral radius at which a P is tried, nearest first."""
MAX_SIZE = 1e5
"""Greatest |A| + |B K| times the length of a piece of g, as the checker takes it."""
MAX_STEPS = 8_000
"""Steps of the enclosure that are tried; each takes the checker some milliseconds for a small plant."""
__all__ = ["SpectralRadius", "plant_data", "spectral_radius", "stability_claim"]
KEY = "linear.stable"
SOURCE = CLAIM_KEYS[KEY].source


@final
@dataclass(frozen=True)
class SpectralRadius:
    """Proved bounds of the largest modulus of a multiplier; 0 and None where none was found.

    Attributes
    ----------
    low, high : the spectral radius lies strictly between them
    certificates : of the upper and of the lower bound, as far as found
    guess : computed spectral radius, not proved
    width : of the monodromy matrix's enclosure: its error over its own size, largest row sums
    """

    low: Fraction
    high: Fraction | None
    certificates: tuple[Certificate, ...]
    guess: float = 0.0
    width: float = 0.0


def spectral_radius(plant: LinearPlant) -> SpectralRadius:
    """Bound the spectral radius of the monodromy matrix from both sides.

    Raises
    ------
    ValueError
        If the schedule is not periodic.
    OverflowError
        If the plant is so fast, or the table so long, that the enclosure would take too many steps.
    """
    if plant.schedule.period is None:
        raise ValueError("Floquet multipliers need a periodic schedule: give it a period")
    scale = balancing_scale(plant)
    steps = steps_needed(plant, scale)
    A, F = _fields(plant, scale)
    longest = float(max(p.length for p in _pieces(plant)) * (norm(A) + norm(F)))
    if steps > MAX_STEPS or longest >= MAX_SIZE:
        size = f"takes {steps} steps (at most {MAX_STEPS} are tried)"
        if steps <= MAX_STEPS:
            size = f"leads over a piece of g that is {longest:.3g} of its times long (at most {MAX_SIZE:g})"
        raise OverflowError(
            "no quadratic function was found that falls at every gain, and enclosing the monodromy matrix "
            f"{size}: period times |A| + |B K| is that long"
        )
    enclosed = monodromy(A, F, plant.schedule.profile)
    centre = np.array([[float(x) for x in row] for row in enclosed[0]])
    guess = float(np.abs(np.linalg.eigvals(centre)).max())
    upper = _proved(plant, scale, enclosed, centre, guess, "below")
    lower = _proved(plant, scale, enclosed, centre, guess, "above")
    found = tuple(c for c in (upper, lower) if c is not None)
    return SpectralRadius(
        Fraction(0) if lower is None else lower.claim["radius"],
        None if upper is None else upper.claim["radius"],
        found,
        guess,
        float(enclosed[1] / norm(enclosed[0])) if norm(enclosed[0]) else 0.0,
    )


def balancing_scale(plant: LinearPlant) -> list[Fraction]:
    """Powers of two d for which the plant of z, x_i = d_i z_i, is slow: its size decides the steps."""
    from scipy.linalg import matrix_balance

    A, F = (np.array([[float(x) for x in row] for row in M]) for M in _fields(plant))
    size = np.abs(A) + np.abs(F)
    np.fill_diagonal(size, 0.0)
    _, (scale, _) = matrix_balance(_bridged(size), permute=False, separate=True)
    return [Fraction(2) ** round(float(np.log2(d))) for d in scale]


def _bridged(size: Array) -> Array:
    """Couplings as balancing needs them: both ways, so that a state nothing leads back from is scaled too."""
    length = float(size.max(initial=0.0))
    return np.where((size == 0) & (size.T > 0), 1e-12 * length, size)


def _fields(plant: LinearPlant, scale: Sequence[Fraction] | None = None) -> tuple[Matrix, Matrix]:
    """A and B K in scaled coordinates."""
    A, B, K = (plant.exact[name] for name in ("A", "B", "K"))
    d = [Fraction(1)] * len(A) if scale is None else scale
    A, F = (
        tuple(tuple(x * d[j] / d[i] for j, x in enumerate(row)) for i, row in enumerate(M))
        for M in (A, rows(of(B) * of(K)))
    )
    return A, F


def steps_needed(plant: LinearPlant, scale: Sequence[Fraction]) -> int:
    """Taylor steps of the enclosure, as the checker cuts a period; one is squared where g is constant."""
    A, F = _fields(plant, scale)
    speed = norm(A) + norm(F)
    constant = norm(F) == 0
    counts = [(max(1, ceil(4 * speed * p.length)), constant or len(p.shape) <= 1) for p in _pieces(plant)]
    return sum(count.bit_length() if squared else count for count, squared in counts)


def _pieces(plant: LinearPlant) -> list[Piece]:
    return list(plant.schedule.profile.pieces)


def stability_claim(plant: LinearPlant) -> Claim:
    """Claim "linear.stable": every solution of the plant tends to zero."""
    statement = "every Floquet multiplier of x' = (A - g(t) B K) x lies inside the unit circle"
    if plant.schedule.period is None:
        return stated(
            KEY, statement, Verdict.UNDECIDED,
            reason="the schedule is a finite table", next_step="give it a period",
        )  # fmt: skip
    growing = growing_part(plant)
    if growing is not None:
        return _refuted_by_volume(growing, statement)
    falling = falling_function(plant)
    try:
        found = spectral_radius(plant)
    except OverflowError as error:
        if falling is not None:
            return _proved_by_function(falling, (), statement)
        return stated(
            KEY, statement, Verdict.UNDECIDED,
            reason=str(error), next_step="leave out states that are fast and stable by themselves",
        )  # fmt: skip
    quantities = _quantities(found)
    if found.high is not None and found.high <= 1:
        evidence = _evidence(found, "P > 0 with M'PM < r^2 P")
        return stated(
            KEY, statement, Verdict.PROVED, (evidence,), quantities,
            (rational_quantity("1 - spectral radius", 1 - found.high, 1 - found.low),),
        )  # fmt: skip
    if falling is not None:
        return _proved_by_function(falling, quantities, statement)
    if found.low >= 1:
        violation = rational_quantity("spectral radius - 1", found.low - 1, (found.high or found.low) - 1)
        if violation.low > 0:
            (certificate,) = (c for c in found.certificates if c.claim["side"] == "above")
            values: dict[str, float | list[float]] = {
                "x": [float(v) for v in certificate.witness["x"]],
                "period": float(plant.schedule.period),
            }
            words = "started here the state grows by more than the spectral radius's bound every period"
            evidence = _evidence(found, "M'PM > r^2 P with x'Px > 0")
            return stated(
                KEY, statement, Verdict.REFUTED, (evidence,), quantities,
                witness=Witness(words, values, violation),
            )  # fmt: skip
    return stated(
        KEY, statement, Verdict.UNDECIDED, quantities=quantities,
        reason=_not_told(found),
        next_step=_step(found),
    )  # fmt: skip


WIDE = 1e-12
"""Relative error of the monodromy matrix above which its enclosure is why nothing is proved."""


def _not_told(found: SpectralRadius) -> str:
    """Say how near 1 the largest multiplier was enclosed."""
    if found.high is None and found.width > WIDE:
        return (
            f"the largest multiplier is computed as {found.guess:.6g} in modulus, and the monodromy matrix "
            f"is enclosed too widely to prove it: its error may be {found.width:.1g} of its size"
        )
    if found.high is None:
        return (
            f"the largest multiplier is computed as {found.guess:.6g} in modulus, and no quadratic function "
            "was found that changes by about that in every period"
        )
    return f"the largest multiplier's modulus lies between {float(found.low):.9g} and {float(found.high):.9g}"


def _step(found: SpectralRadius) -> str:
    if found.high is None and found.width > WIDE:
        return "leave out states that are fast and stable by themselves, or shorten the period"
    return "change a gain or an on-time slightly and see on which side it falls"


def _refuted_by_volume(found: Certificate, statement: str) -> Claim:
    """REFUTED: a part of the plant has multipliers whose product is at least 1 in modulus."""
    count = len(found.witness["W"])
    name = "modulus" if count == 1 else f"geometric mean of the moduli of {count}"
    violation = exponential_quantity("multiplier", found.claim["growth"] / count, name)
    values: dict[str, float | list[float]] = {
        f"W[{i + 1}]": [float(x) for x in row] for i, row in enumerate(found.witness["W"])
    }
    summary = "a carried part whose volume does not shrink (Liouville), checked by the stand-alone checker"
    evidence = Evidence(EvidenceKind.CERTIFICATE, summary, SOURCE, {"certificate": found})
    words = "y = W x moves by itself, and its multipliers multiply to 1 or more"
    return stated(
        KEY, statement, Verdict.REFUTED, (evidence,),
        witness=Witness(words, values, violation),
    )  # fmt: skip


def _proved_by_function(found: Certificate, quantities: tuple[Quantity, ...], statement: str) -> Claim:
    """PROVED: x'Px falls along every solution."""
    summary = "x'Px falls at every gain or over the period, checked by the stand-alone checker"
    evidence = Evidence(EvidenceKind.CERTIFICATE, summary, SOURCE, {"certificate": found})
    return stated(KEY, statement, Verdict.PROVED, (evidence,), quantities)


def _proved(
    plant: LinearPlant,
    scale: Sequence[Fraction],
    enclosed: Enclosed,
    centre: Array,
    guess: float,
    side: str,
) -> Certificate | None:
    """The tightest certificate of one side that the checker accepts."""
    if guess <= 0:
        return None
    for near in _radii(guess, side):
        r = Fraction(round(near * 2**60), 2**60)
        witness = _stein(centre / float(r), side) if r > 0 else None
        if witness is None:
            continue
        if not _changes(enclosed, r, witness["P"], side):
            continue
        witness["scale"] = list(scale)
        certificate = Certificate("floquet", data_of(plant), {"side": side, "radius": r}, witness)
        (finding,) = checker.check_text(certificate_text([certificate]))
        if finding.valid:
            return certificate
    return None


def _radii(guess: float, side: str) -> list[Fraction]:
    """Radii that are tried: near the computed one, then between it and 1, which decides."""
    sign = 1 if side == "below" else -1
    near = [Fraction(guess) * (1 + sign * Fraction(distance)) for distance in BACKING_OFF]
    towards_one = [Fraction(guess**0.5), Fraction((1 + guess) / 2)] if sign * (1 - guess) > 0 else []
    return near + towards_one


def _changes(enclosed: Enclosed, r: Fraction, rows: Matrix, side: str) -> bool:
    """Whether x'Px falls below r^2 of itself, or grows above it, with room for the enclosure's radius."""
    (centre, radius), n = enclosed, len(rows)
    error = n * radius
    room = (2 * n * norm(centre) * error + error**2) * norm(rows)
    M, P = of(centre), of(rows)
    gap = (P * rational(r * r) - M.transpose() * P * M) * (1 if side == "below" else -1)
    if not is_positive_definite(gap - identity(n) * rational(room)):
        return False
    return side == "above" or is_positive_definite(P)


def _stein(scaled: Array, side: str) -> dict[str, Any] | None:
    """P from the Stein equation P - M'PM = +-I, rounded, and for "above" the direction of growth."""
    from scipy.linalg import LinAlgError, solve_discrete_lyapunov

    sign = 1.0 if side == "below" else -1.0
    try:
        with warnings.catch_warnings():  # P is only proposed: what it proves is checked exactly
            warnings.simplefilter("ignore")
            P = solve_discrete_lyapunov(scaled.T, sign * np.eye(len(scaled)), method="direct")
    except (LinAlgError, ValueError):
        return None
    if not np.isfinite(P).all():
        return None
    P = (P + P.T) / (2 * np.abs(P).max())
    rows = [[Fraction(round(x * 2**50), 2**50) for x in row] for row in P.tolist()]
    witness: dict[str, Any] = {"P": rows}
    if side == "above":
        _, vectors = np.linalg.eigh(P)
        witness["x"] = [Fraction(round(v * 2**20), 2**20) for v in vectors[:, -1].tolist()]
    return witness


def _quantities(found: SpectralRadius) -> tuple[Quantity, ...]:
    if found.high is None:
        return ()
    return (
        rational_quantity("spectral_radius", found.low, found.high, label="largest multiplier's modulus"),
    )


def _evidence(found: SpectralRadius, words: str) -> Evidence:
    side = "below" if words.startswith("P > 0") else "above"
    (certificate,) = (c for c in found.certificates if c.claim["side"] == side)
    return Evidence(
        EvidenceKind.CERTIFICATE,
        f"monodromy matrix enclosed in rationals; a rational {words}, checked by the stand-alone checker",
        source=SOURCE,
        details={"certificate": certificate},
    )
