"""Stability of the linear plant x' = (A - g(t) B K) x through periodic windows, PROVED or REFUTED.

The monodromy matrix M is enclosed in rationals; a rational P with M'PM < r^2 P, P > 0 proves that
every Floquet multiplier is below r in modulus, one with M'PM > r^2 P and x'Px > 0 that some
multiplier is above r. Both are checked by the stand-alone checker; floats only propose P.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from math import ceil
from typing import Any, final

import numpy as np

from ...models.linear import LinearPlant
from ...models.types import Array
from .. import checker
from ..certificates.format import Certificate, as_text, certificate_text
from ..certificates.schedule import schedule_data
from ..exact.rational_quantity import rational_quantity
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness

BACKING_OFF = (1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2)
"""Relative distances from the computed spectral radius at which a P is tried, nearest first."""
MAX_STEPS = 20_000
"""Steps of the enclosure that are tried; each is about a millisecond for a small plant."""
Enclosed = tuple[checker.Matrix, Fraction]
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
    OverflowError
        If the plant is so fast, or the table so long, that the enclosure would take too many steps.
    """
    if plant.schedule.period is None:
        raise ValueError("Floquet multipliers need a periodic schedule: give it a period")
    if steps_needed(plant) > MAX_STEPS:
        raise OverflowError(f"enclosing the monodromy matrix takes more than {MAX_STEPS} steps")
    enclosed = _enclosure(plant)
    centre = np.array([[float(x) for x in row] for row in enclosed[0]])
    guess = float(np.abs(np.linalg.eigvals(centre)).max())
    upper = _proved(plant, enclosed, centre, guess, "below")
    lower = _proved(plant, enclosed, centre, guess, "above")
    found = tuple(c for c in (upper, lower) if c is not None)
    return SpectralRadius(
        Fraction(0) if lower is None else lower.claim["radius"],
        None if upper is None else upper.claim["radius"],
        found,
    )


def steps_needed(plant: LinearPlant) -> int:
    """Taylor steps of the enclosure, as the checker cuts a period: at least one a piece of g."""
    feedback = checker.matrix_product(*([list(r) for r in plant.exact[name]] for name in ("B", "K")))
    speed = checker.norm([list(row) for row in plant.exact["A"]]) + checker.norm(feedback)
    knots = plant.schedule.profile.knots
    return sum(max(1, ceil(4 * speed * (b - a))) for a, b in pairwise(knots))


def _enclosure(plant: LinearPlant) -> Enclosed:
    profile = checker.read_profile(checker.Node(as_text(_data(plant)), "data"))
    A, B, K = ([list(row) for row in plant.exact[name]] for name in ("A", "B", "K"))
    return checker.monodromy(A, checker.matrix_product(B, K), profile)


def stability_claim(plant: LinearPlant) -> Claim:
    """Claim "linear.stable": every solution of the plant tends to zero."""
    title = "linear plant stable through the windows"
    statement = "every Floquet multiplier of x' = (A - g(t) B K) x lies inside the unit circle"
    if plant.schedule.period is None:
        return Claim(
            "linear.stable", title, statement, Verdict.UNDECIDED, source=SOURCE,
            reason="the schedule is a finite table", next_step="give it a period",
        )  # fmt: skip
    try:
        found = spectral_radius(plant)
    except OverflowError as error:
        return Claim(
            "linear.stable", title, statement, Verdict.UNDECIDED, source=SOURCE,
            reason=str(error), next_step="scale the fast states, or give fewer windows a period",
        )  # fmt: skip
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


def _proved(
    plant: LinearPlant, enclosed: Enclosed, centre: Array, guess: float, side: str
) -> Certificate | None:
    """The tightest certificate of one side that the checker accepts."""
    if guess <= 0:
        return None
    for distance in BACKING_OFF:
        r = Fraction(guess) * (1 + (Fraction(distance) if side == "below" else -Fraction(distance)))
        r = Fraction(round(r * 2**60), 2**60)
        witness = _stein(centre / float(r), side) if r > 0 else None
        if witness is None:
            continue
        try:
            checker.require_change(*enclosed, side, r, checker.Node(as_text(witness), "witness"))
        except checker.Invalid:
            continue
        certificate = Certificate("floquet", _data(plant), {"side": side, "radius": r}, witness)
        (finding,) = checker.check_text(certificate_text([certificate]))
        if finding.valid:
            return certificate
    return None


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
    return plant_data(plant) | {"schedule": schedule_data(plant.schedule)}


def plant_data(plant: LinearPlant) -> dict[str, Any]:
    """The three matrices as certificate data."""
    return {"plant": dict(plant.exact)}


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
