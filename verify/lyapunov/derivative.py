"""Certify V' <= -rho W on the whole state space, for any law with a storage function.

The way: the closed loop and V in exact polynomials, -V' - rho W split by the symbols known to be
positive, each group a sum of squares on the sphere of quaternions, the Gram matrices found with
Clarabel and rounded, the whole written as a certificate and handed to the stand-alone checker.
Only what the checker accepts counts.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from math import floor
from typing import final

from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..certificates.program import NotAlgebraicError
from ..exact.matrix import Matrix, Rows
from ..exact.polynomial import NotPolynomialError
from .balance import Balance, Problem, balance
from .candidates import Candidate
from .conditions import vertices
from .forms import inertia_data, law_form, parameter_data, storage_form
from .gram_search import Face, Gram, find_gram, largest_rate
from .normal_form import ABOVE_FLOOR, FLOOR, decay_polynomials
from .sums_of_squares import Target, split

BACKING_OFF = (Fraction(1, 10**7), Fraction(1, 10**6), Fraction(1, 10**5), Fraction(1, 1000), Fraction(1, 20))
"""Steps back from the solver's best rate, relative to it, tried in turn."""
NEARLY_ZERO = 1e-7
"""Rates below this, in the unit of the search, are tried as 0."""


@final
@dataclass(frozen=True)
class DecayCertificate:
    """A certificate that V' <= -rate W, accepted by the stand-alone checker.

    Attributes
    ----------
    rate : Fraction, 1/s
    statement : the claim as the checker words it
    """

    certificate: Certificate
    rate: Fraction
    statement: tuple[str, ...]


class NoCertificateError(ValueError):
    """The method does not reach, with the reason."""


def certify_decay(
    candidate: Candidate,
    inertia: Matrix,
    *,
    tolerance: Matrix | None = None,
    weight: Fraction | None = None,
    rate: Fraction | None = None,
    gain_bound: Fraction | None = None,
) -> DecayCertificate:
    """Certify V' <= -rho W, rho as large as the search finds, or as given.

    Parameters
    ----------
    candidate : Candidate
        Storage function on its closed loop.
    inertia, tolerance : (3, 3) exact, kg m^2
        The inertia, and the largest deviation of each entry.
    weight : Fraction or None
        The weight a where the storage function leaves it free.
    rate : Fraction or None
        A rate to prove, 1/s; None for the largest, or 0 beside a law's own W that is not seen to be >= 0.
    gain_bound : Fraction or None
        Restrict the claim to 0 <= g <= gain_bound; None claims it for every g.

    Raises
    ------
    NoCertificateError
        With the reason, if no certificate was found. That refutes nothing.
    """
    try:
        law, storage = law_form(candidate.loop), storage_form(candidate, weight=weight)
    except NotAlgebraicError as error:
        raise NoCertificateError(str(error)) from None
    data = {**inertia_data(inertia, tolerance), "law": law, "parameters": parameter_data(candidate.loop)}
    claim: dict[str, object] = {"storage": storage}
    claim["domain"] = "above floor" if candidate.floor is not None else "everywhere"
    if gain_bound is not None:
        claim["gain_bound"] = gain_bound
    try:
        problems = list(_targets(candidate, vertices(inertia, tolerance), weight, gain_bound))
    except NotPolynomialError as error:
        raise NoCertificateError(str(error)) from None
    if candidate.right_side is None and rate is None and not _is_nonnegative_reference(problems):
        rate = Fraction(0)  # beside a W that may be negative a rate would say nothing
    units = balance(problems)
    scaled = [units.scaled(problem) for problem in problems]
    best = _best_rate(scaled) if rate is None else float(rate / units.unit)
    if best is None:
        raise NoCertificateError("-V' was not found to be a sum of squares of its own degree on the sphere")
    for tried in _rates(best, units.unit) if rate is None else iter([rate]):
        grams = _all_grams(scaled, tried / units.unit, units)
        if grams is not None:
            return _accepted(data, claim, tried, grams, problems[0][0].names)
    ended = best * float(units.unit)
    raise NoCertificateError(
        f"no Gram matrix could be rounded at or below {ended:.6g} 1/s, where the solver's search ended"
    )


Term = tuple[Mapping[str, int], Gram]


def _targets(
    candidate: Candidate, inertias: Iterable[Rows], weight: Fraction | None, gain_bound: Fraction | None
) -> Iterator[Problem]:
    """Polynomial problems, one for each inertia."""
    signed = [FLOOR, ABOVE_FLOOR if candidate.floor is not None else "R"]
    known: list[Target] = []
    for J in inertias:
        gap, reference = decay_polynomials(candidate, J, weight=weight)
        targets = split(gap, reference, signed, gain_bound, known)
        known = known or targets
        yield gap.ring, targets


def _best_rate(problems: list[Problem]) -> float | None:
    """Smallest of the problems' largest rates: found at the first, then wherever its multipliers point."""
    best, where, seen = float("inf"), 0, set[int]()
    while where not in seen:
        seen.add(where)
        found = largest_rate(*problems[where])
        if found is None or found.rate < -NEARLY_ZERO:
            return None
        best = min(best, found.rate)
        bounds = [found.bound(targets) for _, targets in problems]
        where = bounds.index(min(bounds))
    return max(best, 0.0)


def _is_nonnegative_reference(problems: list[Problem]) -> bool:
    """Whether W is a sum of squares, exactly, and not zero: only then does V' <= -rho W bound V' by more."""
    targets = [(ring, target) for ring, problem in problems for target in problem if target.reference]
    alone = [(ring, [replace(t, fixed=t.reference, reference={})]) for ring, t in targets]
    scaled = (balance([problem]).scaled(problem) for problem in alone)
    return bool(targets) and all(find_gram(ring, t, Fraction(0), None) is not None for ring, (t,) in scaled)


def _rates(best: float, unit: Fraction) -> Iterator[Fraction]:
    """Rates to try, 1/s, from just below the best down to zero, with few digits."""
    if best > NEARLY_ZERO:
        for step in BACKING_OFF:
            rate = Fraction(best) * unit * (1 - step)
            digits = Fraction(10) ** (9 - int(f"{float(rate):e}".split("e")[1]))
            yield floor(rate * digits) / digits
    yield Fraction(0)


def _all_grams(problems: list[Problem], rate: Fraction, units: Balance) -> list[list[Term]] | None:
    """Gram matrices of every problem at one rate; None as soon as one problem has none.

    Problems and rate are in the units given, the matrices in those of the claim.
    """
    result: list[list[Term]] = []
    faces: dict[int, Face] = {}
    for ring, targets in problems:
        terms: list[Term] = []
        done: list[tuple[Target, list[Gram]]] = []
        for number, target in enumerate(targets):
            same = (g for t, g in done if (t.fixed, t.reference) == (target.fixed, target.reference))
            grams = next(same, None)
            if grams is None:
                found = find_gram(ring, target, rate, faces.get(number))
                if found is None:
                    return None
                grams, faces[number] = found
            done.append((target, grams))
            terms += [(target.common, units.restored(target, gram)) for gram in grams]
        result.append(terms)
    return result


def _accepted(
    data: dict[str, object],
    claim: dict[str, object],
    rate: Fraction,
    grams: list[list[Term]],
    names: tuple[str, ...],
) -> DecayCertificate:
    """Write the certificate and ask the checker."""
    sums = [[_term(common, gram, names) for common, gram in vertex] for vertex in grams]
    certificate = Certificate("lyapunov-derivative", data, {**claim, "rate": rate}, {"sums": sums})
    (finding,) = checker.check_text(certificate_text([certificate]))
    if not finding.valid:
        raise NoCertificateError(f"the checker refused the certificate: {finding.reason}")
    return DecayCertificate(certificate, rate, finding.claim)


def _term(common: Mapping[str, int], gram: Gram, names: tuple[str, ...]) -> dict[str, object]:
    basis = [
        " ".join(name for name, e in zip(names, key, strict=True) for _ in range(e)) or "1"
        for key in gram.square.basis
    ]
    return {"factors": {**common, **dict(gram.square.factors)}, "basis": basis, "gram": gram.matrix}
