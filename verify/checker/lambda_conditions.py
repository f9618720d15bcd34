"""Kinds sharp-condition and paper-condition: conditions on lambda."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from .body import describe_inertia, inertia_vertices
from .exact_numbers import Matrix, Vector, require, show
from .kinds import kind
from .matrices import show_matrix
from .reading import Node


@kind("sharp-condition")
def check_sharp_condition(data: Node, certificate: Node) -> list[str]:
    """Decide lambda >= sqrt(a)/(2 sqrt(Jmin)), that is 4 lambda^2 J - a I >= 0 with lambda > 0."""
    lam, a = data["parameters"]["lambda"].number(), certificate["claim"]["weight"].number()
    require(lam > 0 and a > 0, "lambda and the weight a must be positive")
    for J, pivots in _with_factors(data, certificate, 4 * lam**2, a):
        require(all(d >= 0 for d in pivots), f"4 lambda^2 J - a I has a negative pivot, J = {show_matrix(J)}")
    return [
        f"lambda >= sqrt(a)/(2 sqrt(Jmin)) for lambda = {show(lam)} 1/s, a = {show(a)} kg m^2/s^2,",
        describe_inertia(data),
    ]


@kind("paper-condition")
def check_paper_condition(data: Node, certificate: Node) -> list[str]:
    """Decide lambda > max(1/(2 Jmin), 1/2), that is 2 lambda J - I > 0 and lambda > 1/2."""
    lam = data["parameters"]["lambda"].number()
    require(lam > Fraction(1, 2), "lambda must exceed 1/2")
    for J, pivots in _with_factors(data, certificate, 2 * lam, Fraction(1)):
        require(all(d > 0 for d in pivots), f"2 lambda J - I is not positive definite, J = {show_matrix(J)}")
    return [f"lambda > max(1/(2 Jmin), 1/2) for lambda = {show(lam)} 1/s,", describe_inertia(data)]


def _with_factors(
    data: Node, certificate: Node, factor: Fraction, shift: Fraction
) -> Iterator[tuple[Matrix, Vector]]:
    """Yield each vertex J and the pivots D of factor J - shift I = L D L', checked."""
    vertices, factors = inertia_vertices(data), certificate["witness"]["factors"].items()
    require(
        len(factors) == len(vertices), "expected one factorisation for each vertex of the box of inertias"
    )
    for J, place in zip(vertices, factors, strict=True):
        (l21, l31, l32), pivots = place["lower"].vector(3), place["pivots"].vector(3)
        L = [
            [Fraction(1), Fraction(0), Fraction(0)],
            [l21, Fraction(1), Fraction(0)],
            [l31, l32, Fraction(1)],
        ]
        for i in range(3):
            for j in range(i + 1):
                product = sum((L[i][k] * pivots[k] * L[j][k] for k in range(3)), Fraction(0))
                wanted = factor * J[i][j] - (shift if i == j else 0)
                require(product == wanted, f"{place.path}: L D L' is not the matrix of the condition")
        yield J, pivots
