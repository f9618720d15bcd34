"""Kind schedule-excitation: persistent excitation."""

from __future__ import annotations

from bisect import bisect_right
from fractions import Fraction
from itertools import pairwise
from math import comb

from .bernstein import power_compose, power_primitive, power_product
from .exact_numbers import Vector, require, show
from .kinds import kind
from .reading import Node
from .schedules import Profile, describe_profile, read_profile, require_smooth


@kind("schedule-excitation")
def check_excitation(data: Node, certificate: Node) -> list[str]:
    """G is C1, and mu1 <= integral of g^2 over [t, t + T] <= mu2 with mu1 > 0, for every t >= 0.

    Of a finite table the claim speaks of the intervals within it.
    """
    profile, claim = read_profile(data), certificate["claim"]
    T, low, high = (claim[name].number() for name in ("length", "least", "greatest"))
    require(T > 0 and low > 0, "the length and the least integral must be positive")
    require_smooth(profile)
    end = profile.knots[-1]
    last = end if profile.period is not None else end - T
    require(last > 0, "the interval does not fit into the table")
    primitives = [power_primitive(power_product(shape, shape)) for shape in profile.shapes]
    lengths = [b - a for a, b in pairwise(profile.knots)]
    sums = [Fraction(0)]
    for q, h in zip(primitives, lengths, strict=True):
        sums.append(sums[-1] + h * sum(q))
    moved = {(knot - T) % end if profile.period is not None else knot - T for knot in profile.knots}
    instants = sorted({t for t in {*profile.knots, *moved, Fraction(0), last} if 0 <= t <= last})
    for a, b in pairwise(instants):
        ends = _along(profile, primitives, sums, a + T, b + T), _along(profile, primitives, sums, a, b)
        size = max(map(len, ends))
        upper, lower = (p + [Fraction(0)] * (size - len(p)) for p in ends)
        moving = [x - y for x, y in zip(upper, lower, strict=True)]
        require(
            _within(moving, low, high, 40),
            f"the integral leaves [mu1, mu2] for t in [{show(a)}, {show(b)}] s",
        )
    where = "for every t >= 0" if profile.period is not None else f"for 0 <= t <= {show(last)} s"
    return [
        f"g is C1 and {show(low)} s <= integral of g^2 over [t, t + {show(T)} s] <= {show(high)} s {where},",
        f"{describe_profile(profile)}",
    ]


def _along(profile: Profile, primitives: list[Vector], sums: Vector, a: Fraction, b: Fraction) -> Vector:
    """Return the integral of g^2 from 0 to t, as a polynomial of u, where t = a + (b - a) u in one piece."""
    end, cycles = profile.knots[-1], Fraction(0)
    if profile.period is not None:
        cycles = Fraction(a // end)
        a, b = a - cycles * end, b - cycles * end
    i = min(bisect_right(profile.knots, a) - 1, len(primitives) - 1)
    start, stop = profile.knots[i], profile.knots[i + 1]
    require(start <= a and b <= stop, "an interval crosses a knot of the schedule")
    h = stop - start
    local = [h * c for c in power_compose(primitives[i], (a - start) / h, (b - a) / h)]
    local[0] += cycles * sums[-1] + sums[i]
    return local


def _within(p: Vector, low: Fraction, high: Fraction, depth: int) -> bool:
    """Whether low <= p <= high on [0, 1], by Bernstein coefficients of ever smaller halves."""
    n = len(p) - 1
    controls = [
        sum((Fraction(comb(i, j), comb(n, j)) * p[j] for j in range(i + 1)), Fraction(0))
        for i in range(n + 1)
    ]
    if all(low <= c <= high for c in controls):
        return True
    if depth == 0 or not (low <= controls[0] <= high and low <= controls[-1] <= high):
        return False
    half = Fraction(1, 2)
    return all(_within(power_compose(p, shift, half), low, high, depth - 1) for shift in (Fraction(0), half))
