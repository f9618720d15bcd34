"""What a floor's steps say of torque and settling, read off boxes."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import isqrt

from .bernstein import bernstein, eighths
from .exact_numbers import require, show
from .floor_steps import Bounds, FloorData, FloorStep, is_blind
from .reading import Node


@dataclass(frozen=True)
class FloorBin:
    """One bin's proved witness."""

    steps: list[FloorStep]
    tail: list[FloorStep]
    ratio: Fraction
    ends: Bounds


def root_above(value: Fraction) -> Fraction:
    """Return a rational >= sqrt(value), within a part in 2^60 of it."""
    if value <= 0:
        return Fraction(0)
    shift = max(0, 120 - value.numerator.bit_length() + value.denominator.bit_length())
    shift += shift % 2
    return Fraction(isqrt((value.numerator << shift) // value.denominator + 1) + 1, 1 << shift // 2)


@dataclass(frozen=True)
class Box:
    """Bounds that hold throughout an eighth of a step.

    `S` and `y` from above; `R` from above; kappa in [low, high]; |g| <= `g`; g' in `slope`.
    """

    stop: Fraction
    S: Fraction
    y: Fraction
    R: Fraction
    low: Fraction
    high: Fraction
    g: Fraction
    slope: tuple[Fraction, Fraction]

    @property
    def bv(self) -> Fraction:
        """Bound of |bv| = sqrt(S' (2 - S')) over S' <= S."""
        inside = min(self.S, Fraction(1))
        return root_above(inside * (2 - inside))


def boxes(d: FloorData, step: FloorStep, *, repeats: bool, limit: Fraction | None = None) -> list[Box]:
    """Return the boxes of a step; `limit` bounds L over all later time, where the step repeats.

    Where it does, S and y are scaled down period by period: they must not rest on bounds that are not.
    """
    bounds = {name: eighths(p) for name, p in step.x.items()}
    length = (step.stop - step.start) / 8
    result = []
    for i in range(8):
        start = step.start + i * length
        low, high = ({name: pairs[i][side] for name, pairs in bounds.items()} for side in (0, 1))
        g = d.profile.gain(start, start + length)
        slope = [c / length for c in bernstein(g.derivative())]
        shared = (max(map(abs, bernstein(g))), (min(slope), max(slope)))
        if d.law == "persistence-filter":
            require(low["r"] > 0 and low["K"] > 0, "the floor is not positive")
            share = d.R0 / low["r"]
            S, y = high["z"] ** 2 * share, high["v"] * root_above(share)
            if not is_blind(step):
                S, y = min(S, high["s"] ** 2), min(y, high["y"])
            elif not repeats:
                S, y = min(S, Fraction(2)), min(y, high["y"])
            result.append(Box(start + length, S, y, 1 / low["K"], low["K"], 1 / low["r"], *shared))
        else:
            top = high["L"] if limit is None else limit
            result.append(Box(start + length, high["Z"] ** 2, high["Y"], high["U"], low["k"], top, *shared))
    return result


Boxes = tuple[list[Box], list[Box]]


def all_boxes(d: FloorData, proved: FloorBin) -> Boxes:
    """Boxes of a bin's transient, and of the first period of its repeating part."""
    transient = [box for step in proved.steps for box in boxes(d, step, repeats=False)]
    limit = None
    if proved.tail and "L" in proved.tail[0].ends:
        first, last = proved.tail[0].ends["L"][0], proved.tail[-1].ends["L"][1]
        limit = first + max(last - first, Fraction(0)) / (1 - proved.ratio**2)
    return transient, [box for step in proved.tail for box in boxes(d, step, repeats=True, limit=limit)]


def rate_above(d: FloorData, box: Box, bv: Fraction) -> Fraction:
    """Bound of |w| <= |Omega| + 2 g^2 kappa |bv|, with |Omega| <= y/sqrt(Jmin) <= sqrt(8) c y."""
    return root_above(8 * d.c * d.c * box.y * box.y) + 2 * box.g**2 * box.high * bv


def check_settling(claim: Node, bins: list[FloorBin], covered: list[Boxes], d: FloorData) -> list[str]:
    """Check that |bv| and |w| stay within tolerances from a time on, if that is claimed."""
    if not claim.has("settling"):
        return []
    node = claim["settling"]
    time, attitude, rate = (node[name].number() for name in ("time", "attitude", "rate"))
    for proved, (transient, repeated) in zip(bins, covered, strict=True):
        for box in transient:
            bv = box.bv
            within = bv <= attitude and rate_above(d, box, bv) <= rate
            require(box.stop <= time or within, f"not settled before {show(box.stop)} s")
        if not repeated:
            require(claim.has("horizon"), "a bin has no repeating part")
            continue
        period = d.profile.period
        assert period is not None
        n = max(int((time - proved.tail[0].start) // period), 0)
        require(n <= 10**5, "the settling time is out of range")
        for periods in (n, n + 1):
            scale = proved.ratio**periods
            for box in repeated:
                bv = root_above(2 * box.S)
                within = bv * scale <= attitude and rate_above(d, box, bv) * scale <= rate
                stop = box.stop + periods * period
                require(stop <= time or within, f"not settled before {show(stop)} s")
    end = f" up to {show(claim['horizon'].number())} s" if claim.has("horizon") else " for good"
    return [f"and |bv| <= {show(attitude)}, |w| <= {show(rate)} rad/s from t = {show(time)} s on{end}"]


def check_torque(claim: Node, covered: list[Boxes], d: FloorData) -> list[str]:
    """Check a bound of the Euclidean norm of the applied torque g u, if one is claimed.

    u = q J bv - 2 g kappa bv x J Omega + 4 g^3 kappa^2 bv x J bv - g kappa J (b0 Omega + bv x Omega)
        - (g/2) kappa (1 + b0) J Omega,   q = -4 g' kappa - 2 g kappa' + 2 g^3 kappa^2 b0.
    """
    if not claim.has("torque"):
        return []
    bound = claim["torque"].number()
    least, root = 1 / (8 * d.c * d.c), root_above(d.greatest)
    for transient, repeated in covered:
        for box in (*transient, *repeated):
            g, high, n = box.g, box.high, box.bv
            u = (
                max(abs(q) for q in torque_coefficient(d, box)) * d.greatest * n
                + 2 * g * high * n * root * box.y
                + 2 * g**3 * high**2 * (d.greatest - least) * n**2
                + g * high * d.greatest * root_above(box.y**2 / least)
                + g * high * root * box.y
            )
            require(g * u <= bound, f"the torque is not bounded before {show(box.stop)} s")
    return [f"and |g u| <= {show(bound)} N m (Euclidean)"]


def torque_coefficient(d: FloorData, box: Box) -> tuple[Fraction, Fraction]:
    """Bounds of q."""
    g, high, zero = box.g, box.high, Fraction(0)
    slope = [-4 * s * k for s in box.slope for k in (box.low, high)]
    b0, square = 1 - min(box.S, Fraction(2)), 2 * g**3 * high**2
    if d.law == "persistence-filter":  # kappa' = lambda kappa - g^2 kappa^2 (1 + b0)
        low = -2 * g * d.lam * high + min(square * (1 + 2 * b0), zero)
        return min(slope) + low, max(slope) + 3 * square
    y2 = box.y**2
    intake = min(2 * (y2 + 2 * d.a * box.S), 2 * d.a * (1 + y2 / (4 * d.a)) ** 2)
    low = -2 * g**3 * d.gamma * box.R * intake + min(square * b0, zero)
    return min(slope) + low, max(slope) + square
