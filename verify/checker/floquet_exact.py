"""Kinds floquet-liouville and floquet-lyapunov: multipliers told from 1 without the monodromy matrix."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from .bernstein import Form, from_powers
from .exact_numbers import MAX_COUNT, Matrix, require, show
from .kinds import kind
from .matrices import is_positive_definite, is_symmetric, matrix_product, show_matrix
from .reading import Node
from .schedules import Profile, describe_profile, read_profile


def read_plant(data: Node) -> tuple[Matrix, Matrix, Profile, Fraction, list[str]]:
    """Return A, F = B K, the periodic profile, its integral over a period, and the plant for people."""
    plant = data["plant"]
    A, B, K = (plant[name].matrix() for name in ("A", "B", "K"))
    n = len(A)
    require(n <= MAX_COUNT, "the plant has too many states")
    fits = len(A[0]) == n and len(B) == n and len(K) == len(B[0]) and len(K[0]) == n
    require(fits, "A, B and K do not fit each other")
    profile = read_profile(data)
    require(profile.period is not None, "Floquet multipliers need a periodic schedule")
    pieces = zip(profile.shapes, pairwise(profile.knots), strict=True)
    total = sum(((b - a) * c / (j + 1) for shape, (a, b) in pieces for j, c in enumerate(shape)), Fraction(0))
    words = [
        f"for x' = (A - g(t) B K) x, A = {show_matrix(A)}, B = {show_matrix(B)}, K = {show_matrix(K)},",
        describe_profile(profile),
    ]
    return A, matrix_product(B, K), profile, total, words


def transposed(A: Matrix) -> Matrix:
    """Return A'."""
    return [list(column) for column in zip(*A, strict=True)]


def trace(A: Matrix) -> Fraction:
    """Return the sum of the diagonal."""
    return sum((A[i][i] for i in range(len(A))), Fraction(0))


def combined(A: Matrix, a: Fraction, F: Matrix, f: Fraction) -> Matrix:
    """Return a A - f F."""
    return [[a * x - f * y for x, y in zip(*rows, strict=True)] for rows in zip(A, F, strict=True)]


@kind("floquet-liouville")
def check_liouville(data: Node, certificate: Node) -> list[str]:
    """Some multiplier has modulus at least 1: the plant carries a part whose volume does not shrink.

    On the left W A = S W and W B K = R W for a W of full row rank k, so that y = W x obeys y' = (S - g R) y;
    on the right A' and (B K)' take the places of A and B K, and x = W'z solves the plant. The product of the
    k multipliers of that part is exp(T tr S - tr R int_0^T g), by Liouville's formula, and they are
    multipliers of the plant.
    """
    A, F, profile, total, words = read_plant(data)
    claim, witness = certificate["claim"], certificate["witness"]
    side = witness["side"].text()
    require(side in ("left", "right"), "a part lies on the left or on the right")
    if side == "right":
        A, F = transposed(A), transposed(F)
    W = witness["W"].matrix(columns=len(A))
    S, R = (witness[name].matrix(len(W), len(W)) for name in ("S", "R"))
    require(is_positive_definite(matrix_product(W, transposed(W))), "the rows of W depend on each other")
    for own, part in ((A, S), (F, R)):
        require(matrix_product(W, own) == matrix_product(part, W), "W is not carried along")
    assert profile.period is not None
    growth = profile.period * trace(S) - total * trace(R)
    require(claim["growth"].number() == growth, "the logarithm of the volume's growth is another")
    require(growth >= 0, "the volume shrinks")
    than = "at least" if growth == 0 else "above"
    return [
        f"some Floquet multiplier is {than} 1 in modulus (not stable): {len(W)} of them multiply to "
        f"exp({show(growth)})",
        *words,
    ]


@kind("floquet-lyapunov")
def check_lyapunov(data: Node, certificate: Node) -> list[str]:
    """Every multiplier lies inside the unit circle: x'Px falls, at every gain or over the whole period.

    "gains": A - g B K has x'Px fall strictly at the least and the greatest gain, so at every g between.
    "commuting": A B K = B K A: the monodromy matrix is exp(N), N = T A - (int g) B K, and N'P + P N < 0.
    """
    A, F, profile, total, words = read_plant(data)
    witness, n = certificate["witness"], len(A)
    require(certificate["claim"]["side"].text() == "below", "this kind bounds multipliers from above")
    P, form = witness["P"].matrix(n, n), witness["form"].text()
    require(is_symmetric(P) and is_positive_definite(P), "P is not symmetric and positive definite")
    assert profile.period is not None
    if form == "commuting":
        require(matrix_product(A, F) == matrix_product(F, A), "A and B K do not commute")
        fields = [combined(A, profile.period, F, total)]
    else:
        require(form == "gains", f"there is no form {form!r}")
        least, greatest = witness["least"].number(), witness["greatest"].number()
        for shape in {tuple(shape) for shape in profile.shapes}:
            g = from_powers(list(shape) or [Fraction(0)])
            rooms = (Form.constant(greatest) - g, g - Form.constant(least))
            require(all(x.is_nonnegative(40) for x in rooms), "g is not proved to stay between the gains")
        fields = [combined(A, Fraction(1), F, gain) for gain in (least, greatest)]
    for N in fields:
        fall = matrix_product(P, N)
        gap = [[-fall[i][j] - fall[j][i] for j in range(n)] for i in range(n)]
        require(is_positive_definite(gap), "x'Px does not fall")
    return ["every Floquet multiplier is below 1 in modulus (stable)", *words]
