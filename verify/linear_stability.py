"""Stability of the linear plant x' = (A - g(t) B K) x through periodic windows, PROVED or REFUTED.

The monodromy matrix M is enclosed in rationals; a rational P with M'PM < r^2 P, P > 0 proves that
every Floquet multiplier is below r in modulus, one with M'PM > r^2 P and x'Px > 0 that some
multiplier is above r. Both are checked by the stand-alone checker; floats only propose P.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from ..models.linear import LinearPlant
from . import checker
from .certificates.format import Certificate, certificate_text
from .certificates.schedule import schedule_data
from .rational_quantity import rational_quantity
from .verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness

Array = NDArray[np.float64]
BACKING_OFF = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Relative distances from the computed spectral radius at which a P is tried, nearest first."""
SOURCE = "Floquet's theorem; Stein's inequality"


@final
@dataclass(frozen=True)
class SpectralRadius:
    """Proved bounds of the largest modulus of a multiplier; 0 and None where none was found.

    Attributes
    ----------
    low, high : the spectral radius lies strictly between them
    certificates : of the upper and of the lower bound, as far as found
    """

    low: Fraction
    high: Fraction | None
    certificates: tuple[Certificate, ...]


def spectral_radius(plant: LinearPlant) -> SpectralRadius:
    """Bound the spectral radius of the monodromy matrix from both sides.

    Raises
    ------
    ValueError
        If the schedule is not periodic.
    """
    if plant.schedule.period is None:
        raise ValueError("Floquet multipliers need a periodic schedule: give it a period")
    monodromy = plant.floquet().monodromy
    guess = float(np.abs(np.linalg.eigvals(monodromy)).max())
    upper = next(_proved(plant, monodromy, guess, "below"), None)
    lower = next(_proved(plant, monodromy, guess, "above"), None)
    found = tuple(c for c in (upper, lower) if c is not None)
    return SpectralRadius(
        Fraction(0) if lower is None else lower.claim["radius"],
        None if upper is None else upper.claim["radius"],
        found,
    )


def stability_claim(plant: LinearPlant) -> Claim:
    """Claim "linear.stable": every solution of the plant tends to zero."""
    title = "linear plant stable through the windows"
    statement = "every Floquet multiplier of x' = (A - g(t) B K) x lies inside the unit circle"
    if plant.schedule.period is None:
        return Claim(
            "linear.stable", title, statement, Verdict.UNDECIDED, source=SOURCE,
            reason="the schedule is a finite table", next_step="give it a period",
        )  # fmt: skip
    found = spectral_radius(plant)
    quantities = _quantities(found)
    if found.high is not None and found.high <= 1:
        evidence = _evidence(found, "P > 0 with M'PM < r^2 P")
        return Claim(
            "linear.stable", title, statement, Verdict.PROVED, (evidence,), quantities,
            (rational_quantity("1 - spectral radius", 1 - found.high, 1 - found.low),), source=SOURCE,
        )  # fmt: skip
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
            return Claim(
                "linear.stable", title, statement, Verdict.REFUTED, (evidence,), quantities,
                witness=Witness(words, values, violation), source=SOURCE,
            )  # fmt: skip
    return Claim(
        "linear.stable", title, statement, Verdict.UNDECIDED, quantities=quantities, source=SOURCE,
        reason="the spectral radius could not be told from 1",
        next_step="change a gain or an on-time slightly and see on which side it falls",
    )  # fmt: skip


def _proved(plant: LinearPlant, monodromy: Array, guess: float, side: str) -> Iterator[Certificate]:
    """Certificates the checker accepts, tightest first."""
    if guess <= 0:
        return
    data = _data(plant)
    for distance in BACKING_OFF:
        r = Fraction(guess) * (1 + (Fraction(distance) if side == "below" else -Fraction(distance)))
        r = Fraction(round(r * 2**60), 2**60)
        witness = _stein(monodromy / float(r), side)
        if witness is None or r <= 0:
            continue
        certificate = Certificate("floquet", data, {"side": side, "radius": r}, witness)
        (finding,) = checker.check_text(certificate_text([certificate]))
        if finding.valid:
            yield certificate


def _stein(scaled: Array, side: str) -> dict[str, Any] | None:
    """P from the Stein equation P - M'PM = +-I, rounded, and for "above" the direction of growth."""
    from scipy.linalg import LinAlgError, solve_discrete_lyapunov

    sign = 1.0 if side == "below" else -1.0
    try:
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


def _data(plant: LinearPlant) -> dict[str, Any]:
    matrices = {
        name: [[Fraction(x) for x in row] for row in getattr(plant, name).tolist()]
        for name in ("A", "B", "K")
    }
    return {"plant": matrices, "schedule": schedule_data(plant.schedule)}


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
