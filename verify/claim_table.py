"""Every claim the package makes: title, what it says in general, on what it rests, source, what counts.

Deciders make their claims with `stated`, which takes title and source from here; `intermit explain` reads
this; a scenario's `[check] claims` names these keys; `study/check/makers.py` says who decides them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from .verdict import Claim, Evidence, Quantity, Verdict, Witness


@final
@dataclass(frozen=True)
class ClaimKey:
    """One kind of claim.

    Attributes
    ----------
    says : the claim in general terms
    rests_on : the argument, in one or two sentences
    source : where it comes from
    page : the package's own page that derives it
    by_law : whether it is made of each law, or of the schedule
    counts : whether it decides the exit code unless the scenario says otherwise
    """

    key: str
    title: str
    says: str
    rests_on: str
    source: str
    page: str
    by_law: bool
    counts: bool


PAPER = "Ram & Akella, AAS 21-402"
_ROBUST = "docs/theory-robust.md"
_SCHEDULE, _FLOOR, _LYAPUNOV = "docs/schedule.md", "docs/theory-floor.md", "docs/theory-lyapunov.md"

CLAIM_KEYS: dict[str, ClaimKey] = {
    entry.key: entry
    for entry in (
        ClaimKey(
            "schedule.order",
            "windows ordered and disjoint",
            "The thruster windows are not empty, in order of time, and do not overlap, from one period to "
            "the next as well.",
            "Comparison of the table's numbers as exact rationals.",
            PAPER,
            _SCHEDULE,
            by_law=False,
            counts=True,
        ),
        ClaimKey(
            "schedule.smooth",
            "g is C1",
            "The gain g(t) and its slope are continuous at every knot. The laws use g', so a jump in g "
            "would ask for an impulse of torque.",
            "Value and slope of both neighbours of every knot, as exact rationals.",
            PAPER,
            _SCHEDULE,
            by_law=False,
            counts=True,
        ),
        ClaimKey(
            "schedule.support",
            "g is zero outside the windows",
            "g(t) = 0 wherever full thrust is not certain.",
            "Every piece of g compared with every window in exact rationals.",
            PAPER,
            _SCHEDULE,
            by_law=False,
            counts=True,
        ),
        ClaimKey(
            "schedule.uncertain-thrust",
            "g is zero while the thrust is uncertain",
            "g(t) = 0 for thruster_rise before and thruster_fall after each window.",
            "Every piece of g compared with those intervals in exact rationals.",
            PAPER,
            _SCHEDULE,
            by_law=False,
            counts=True,
        ),
        ClaimKey(
            "schedule.excitation",
            "g is persistently exciting",
            "The integral of g^2 over every interval of length T is at least mu1 > 0 and at most mu2.",
            "mu1 and mu2 are extremes of an exact piecewise polynomial, enclosed by its Bernstein "
            "coefficients; mu1 > 0 exactly when T exceeds the longest time in which g is zero.",
            PAPER + "; " + _SCHEDULE,
            _SCHEDULE,
            by_law=False,
            counts=True,
        ),
        ClaimKey(
            "linear.stable",
            "linear plant stable through the windows",
            "Every solution of x' = (A - g(t) B K) x tends to zero: all its Floquet multipliers over one "
            "period of the windows lie inside the unit circle. Claimed where the scenario has [linear].",
            "The monodromy matrix M enclosed in rationals by Taylor steps; a rational P > 0 with M'PM < P "
            "proves stability, one with M'PM > P and x'Px > 0 for some x the opposite.",
            "Floquet's theorem; Stein's inequality",
            "docs/theory-linear.md",
            by_law=False,
            counts=True,
        ),
        ClaimKey(
            "filter.start",
            "filter starts in range",
            "0 < R(0) <= 2 max g^2 / lambda. With it R <= 2 max g^2 / lambda for ever; without the second "
            "half the bound is max(R(0), 2 max g^2 / lambda).",
            "R' <= -lambda R + 2 g^2.",
            PAPER + " (erratum E10: the printed bound on R needs this condition on R(0))",
            _FLOOR,
            by_law=True,
            counts=False,
        ),
        ClaimKey(
            "lambda.paper",
            "paper's condition on lambda",
            "lambda > max{1/(2 Jmin), 1/2}: sufficient for V' <= 0 with the paper's V.",
            "bv.Omega <= (|bv|^2 + |Omega|^2)/2.",
            PAPER + ", condition on lambda",
            _LYAPUNOV,
            by_law=True,
            counts=False,
        ),
        ClaimKey(
            "lambda.sharp",
            "sharp condition on lambda",
            "lambda >= 1/(2 sqrt(Jmin)): sufficient and necessary for V' <= 0 on the whole state space with "
            "the paper's V. Never above the paper's condition.",
            "Q maximised over Omega: bv'J^-1 bv/(4 lambda) - 2 lambda (1 - b0).",
            _LYAPUNOV + ": largest value of Q over the rate, at b0 -> 1",
            _LYAPUNOV,
            by_law=True,
            counts=False,
        ),
        ClaimKey(
            "lambda.rate",
            "certified decay rate",
            "V_a' <= -rho V_a (persistence filter) or V_a' <= -rho W on R >= R_min (adaptive), with "
            "rho = lambda - sqrt(a/Jmin)/2.",
            "A matrix inequality, tight, checked in rationals.",
            _LYAPUNOV + "; " + PAPER,
            _LYAPUNOV,
            by_law=True,
            counts=False,
        ),
        ClaimKey(
            "lyapunov.identity",
            "closed form of V'",
            "V' = R Q + g^2 (1 - k* R) P along the closed loop, exactly.",
            "A polynomial identity modulo |beta|^2 = 1, in rationals.",
            _LYAPUNOV + "; " + PAPER,
            _LYAPUNOV,
            by_law=True,
            counts=False,
        ),
        ClaimKey(
            "lyapunov.derivative",
            "V' <= 0",
            "The storage function V never grows, at any state with R >= R_min and any gain g in range.",
            "-Q is a sum of squares on S^3 x R^3: a Gram matrix in rationals, checked by exact LDL^T. "
            "This is about V, not about the laws: where it fails, they may still converge.",
            _LYAPUNOV + "; " + PAPER,
            _LYAPUNOV,
            by_law=True,
            counts=False,
        ),
        ClaimKey(
            "filter.floor",
            "R stays above a floor",
            "R(t) >= R_min > 0 for every start in the initial set and all t covered.",
            "Comparison systems integrated with outward rounding; for a periodic g, one period that repeats.",
            "comparison theorem of Mueller and Walter; " + _FLOOR,
            _FLOOR,
            by_law=True,
            counts=True,
        ),
        ClaimKey(
            "convergence",
            "attitude and rate converge",
            "From every start in the initial set the error angle and the rate go to zero, within a proved "
            "envelope; for any lambda > 0.",
            "|Omega|_J decays as exp(-m/2) and the attitude follows in cascade, with m the integral of "
            "g^2 kappa (1 + b0), which the floor of R bounds from below.",
            _FLOOR,
            _FLOOR,
            by_law=True,
            counts=True,
        ),
        ClaimKey(
            "torque.limit",
            "applied torque within its limit",
            "The applied torque g u never exceeds the limit, from any start in the initial set.",
            "Proved by the certified bounds on R, k, the angle and the rate, put into the law; refuted by "
            "one run from the set, enclosed in ball arithmetic.",
            _FLOOR,
            _FLOOR,
            by_law=True,
            counts=True,
        ),
        ClaimKey(
            "robust.floor",
            "R stays above a floor on every body",
            "R(t) >= R_min > 0 from every start in the initial set, for every body, thruster and disturbance "
            "of [uncertainty]; the controller computes with the inertia of [spacecraft] and its own g.",
            "Comparison systems whose constants hold for every body, integrated with outward rounding.",
            _ROBUST,
            _ROBUST,
            by_law=True,
            counts=True,
        ),
        ClaimKey(
            "robust.convergence",
            "attitude and rate converge on every body",
            "The error angle and the rate go to zero from every start, for every body and thruster of "
            "[uncertainty], where no disturbance acts.",
            "The same comparison systems over one period that repeats, scaled down.",
            _ROBUST,
            _ROBUST,
            by_law=True,
            counts=True,
        ),
        ClaimKey(
            "robust.ultimate",
            "attitude and rate stay within a bound on every body",
            "From some time on the error angle and the rate stay within a bound, for every body, thruster "
            "and disturbance of [uncertainty].",
            "The same comparison systems over one period that repeats.",
            _ROBUST,
            _ROBUST,
            by_law=True,
            counts=True,
        ),
    )
}


def stated(
    key: str,
    statement: str,
    verdict: Verdict,
    evidence: tuple[Evidence, ...] = (),
    quantities: tuple[Quantity, ...] = (),
    margins: tuple[Quantity, ...] = (),
    *,
    title: str = "",
    witness: Witness | None = None,
    reason: str = "",
    next_step: str = "",
    counted: bool | None = None,
) -> Claim:
    """Make the claim of a key with its title and its source from the table.

    Parameters
    ----------
    key : str
        An entry of the table.
    statement : str
        What is claimed, in one sentence, with the numbers put in.
    verdict : Verdict
        With what it needs: see `Claim`.
    evidence, quantities, margins : tuple
        What supports it, what was found, and how much may change.
    title : str
        Another title, where the claim is of another kind this time (a table that ends).
    witness, reason, next_step : Witness or str
        What REFUTED and UNDECIDED need.
    counted : bool or None
        Whether it decides the exit code; None leaves that to the table.
    """
    entry = CLAIM_KEYS[key]
    return Claim(
        key=key,
        title=title or entry.title,
        statement=statement,
        verdict=verdict,
        evidence=evidence,
        quantities=quantities,
        margins=margins,
        witness=witness,
        reason=reason,
        next_step=next_step,
        source=entry.source,
        counted=entry.counts if counted is None else counted,
    )


def order_of(key: str) -> int:
    """Position of a key in tables; unknown keys come last."""
    keys = list(CLAIM_KEYS)
    return keys.index(key) if key in CLAIM_KEYS else len(keys)
