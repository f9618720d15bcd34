"""Corners of a zonotope, exact: what one-sided thrusters can do, without trying every choice of them."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations
from math import gcd, lcm

Point = tuple[int, int, int]
Vertex = tuple[Fraction, Fraction, Fraction]


def zonotope_vertices(generators: Sequence[Vertex]) -> list[Vertex]:
    """Vertices of {sum f_j a_j : 0 <= f_j <= 1} in space: at most m (m - 1) + 2 of them, not 2^m.

    A vertex lies on a facet, there on an edge, and is an end of it: a facet's normal is a cross product of
    two generators, an edge's direction is a generator. Signs are decided in whole numbers.
    """
    scale = lcm(*(x.denominator for a in generators for x in a))
    whole = [a for g in generators if any(a := _whole(g, scale))]
    found: dict[Point, None] = {}
    normals = {_primitive(n): None for a, b in combinations(whole, 2) if any(n := _cross(a, b))}
    for n in normals:
        for normal in (n, _minus(n)):
            base = _sum(a for a in whole if _dot(normal, a) > 0)
            flat = [a for a in whole if _dot(normal, a) == 0]
            found |= {_add(base, point): None for point in _in_plane(flat, normal)}
    if not normals:
        found |= dict.fromkeys(_ends(whole))
    return [(Fraction(x, scale), Fraction(y, scale), Fraction(z, scale)) for x, y, z in found]


def _in_plane(flat: list[Point], normal: Point) -> Iterator[Point]:
    """Corners of the zonogon of generators at right angles to a normal."""
    for a in flat:
        p = _cross(normal, a)
        for side in (p, _minus(p)):
            base = _sum(b for b in flat if _dot(side, b) > 0)
            for end in _ends([b for b in flat if _dot(side, b) == 0]):
                yield _add(base, end)


def _ends(line: list[Point]) -> Iterator[Point]:
    """Both ends of a segment of parallel generators; the origin where there are none."""
    along = line[0] if line else (0, 0, 0)
    for direction in (along, _minus(along)):
        yield _sum(b for b in line if _dot(direction, b) > 0)


def _whole(a: Vertex, scale: int) -> Point:
    x, y, z = (int(c * scale) for c in a)
    return x, y, z


def _primitive(n: Point) -> Point:
    """The direction of a normal, either sign as one."""
    size = gcd(*n)
    x, y, z = (c // size for c in n)
    first = x or y or z
    return (x, y, z) if first > 0 else (-x, -y, -z)


def _cross(a: Point, b: Point) -> Point:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _dot(a: Point, b: Point) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _minus(a: Point) -> Point:
    return -a[0], -a[1], -a[2]


def _add(a: Point, b: Point) -> Point:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def _sum(points: Iterator[Point]) -> Point:
    total: Point = (0, 0, 0)
    for point in points:
        total = _add(total, point)
    return total
