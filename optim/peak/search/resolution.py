"""What double precision can tell apart in time: pieces too short for it are left unused, and counted.

The solvers see instants as fractions of the transfer time in double precision. A piece of the
window profile shorter than `SHORTEST` of it has edges that coincide, or a length of a few digits. Such
pieces are taken as closed, a little of their neighbours with them: whatever is found for these
smaller windows is a transfer through the true ones. What it may cost is estimated from the
switching function and belongs to the gain of finer cells.
"""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import numpy as np

from ....models.schedule import Piece, PiecewisePolynomial
from ....models.schedule.polynomial import ZERO, Coefficients, antiderivative, compose_affine, evaluate
from ...problem import TransferProblem
from ..check.switching import SwitchingFunction

SHORTEST = Fraction(1, 10**12)
"""Shortest piece that is used, as a fraction of the transfer time."""


def resolved(problem: TransferProblem) -> TransferProblem:
    """The same transfer through windows that double precision resolves, each inside a true one.

    The problem itself where nothing is too short. Every piece of the result lasts at least a quarter
    of `SHORTEST`.
    """
    shortest = problem.horizon * SHORTEST
    pieces = list(problem.window.pieces)
    short = [piece.length < shortest for piece in pieces]
    if not any(short):
        return problem
    parts: list[tuple[Fraction, Coefficients]] = []
    for i, piece in enumerate(pieces):
        start, end = piece.start, piece.end
        if not short[i]:
            start += shortest / 4 if i > 0 and short[i - 1] else 0
            end -= shortest / 4 if i + 1 < len(pieces) and short[i + 1] else 0
        shape = ZERO if short[i] else _part(piece, start, end)
        if parts and parts[-1][0] < start:
            parts.append((start, ZERO))
        parts.append((end, shape))
    return replace(problem, window=_joined(parts))


def open_time(window: PiecewisePolynomial) -> Fraction:
    """Integral of w over the transfer, s, exact."""
    parts = (p.length * evaluate(antiderivative(p.shape), Fraction(1)) for p in window.pieces)
    return sum(parts, Fraction(0))


def unresolved(problem: TransferProblem, sigma: SwitchingFunction) -> float:
    """Fraction by which window time left unused, and rounded window edges, may change the peak.

    To first order a second of open time at t is worth support(sigma(t)), here its largest value.
    """
    active = sigma.answer.shooting.scaled.problem
    lost = open_time(problem.window) - open_time(active.window)
    edges = 2 * len(active.open_pieces)
    share = float(lost / active.horizon) + edges * float(np.finfo(float).eps)
    return share * sigma.largest_worth


def _part(piece: Piece, start: Fraction, end: Fraction) -> Coefficients:
    """Shape of the part of a piece between two instants."""
    shift, slope = (start - piece.start) / piece.length, (end - start) / piece.length
    return compose_affine(piece.shape, shift, slope)


def _joined(parts: list[tuple[Fraction, Coefficients]]) -> PiecewisePolynomial:
    """Profile of consecutive (end, shape) from 0, neighbouring closed pieces made one."""
    knots: list[Fraction] = [Fraction(0)]
    shapes: list[Coefficients] = []
    for end, shape in parts:
        if shapes and shape == ZERO and shapes[-1] == ZERO:
            knots[-1] = end
            continue
        knots.append(end)
        shapes.append(shape)
    return PiecewisePolynomial(tuple(knots), tuple(shapes))
