"""What the steps of a proof by comparison say of torque and settling, read off boxes."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .bernstein import bernstein, eighths
from .comparison import Bounds, Comparison, Setting
from .exact_numbers import require, show
from .floor_bounds import Box, root_above
from .floor_steps import FloorStep
from .reading import Node


@dataclass(frozen=True)
class FloorBin:
    """One bin's proved witness."""

    steps: list[FloorStep]
    tail: list[FloorStep]
    ratio: Fraction
    ends: Bounds


def boxes(
    system: Comparison, setting: Setting, step: FloorStep, *, repeats: bool, limits: Bounds
) -> list[Box]:
    """Return the boxes of a step; `limits` bounds components over all later time, where the step repeats."""
    bounds = {name: eighths(p) for name, p in step.x.items()}
    length = (step.stop - step.start) / 8
    result = []
    for i in range(8):
        start = step.start + i * length
        low, high = ({name: pairs[i][side] for name, pairs in bounds.items()} for side in (0, 1))
        g = setting.profile.gain(start, start + length)
        slope = [c / length for c in bernstein(g.derivative())]
        read = dict(system.box(low, high, step.modes, repeats=repeats, limits=limits))
        S, y, least, most = (read.pop(name) for name in ("S", "y", "low", "high"))
        gains = bernstein(g)
        lowest, greatest = max(Fraction(0), min(gains)), max(map(abs, gains))
        slopes = (min(slope), max(slope))
        result.append(Box(start + length, S, y, least, most, greatest, slopes, lowest, read))
    return result


Boxes = tuple[list[Box], list[Box]]


def all_boxes(system: Comparison, setting: Setting, proved: FloorBin) -> Boxes:
    """Boxes of a bin's transient, and of the first period of its repeating part."""
    transient = [box for s in proved.steps for box in boxes(system, setting, s, repeats=False, limits={})]
    limits: Bounds = {}
    if proved.tail:
        first = {name: ends[0] for name, ends in proved.tail[0].ends.items()}
        last = {name: ends[1] for name, ends in proved.tail[-1].ends.items()}
        limits = system.limits(first, last, proved.ratio)
    return transient, [
        box for step in proved.tail for box in boxes(system, setting, step, repeats=True, limits=limits)
    ]


def rate_above(setting: Setting, box: Box, bv: Fraction) -> Fraction:
    """Bound of |w| <= |Omega| + 2 g^2 kappa |bv|, with |Omega| <= y/sqrt(Jmin) <= sqrt(8) c y."""
    return root_above(8 * setting.c * setting.c * box.y * box.y) + 2 * box.g**2 * box.high * bv


def check_settling(claim: Node, bins: list[FloorBin], covered: list[Boxes], setting: Setting) -> list[str]:
    """Check that |bv| and |w| stay within tolerances from a time on, if that is claimed."""
    if not claim.has("settling"):
        return []
    node = claim["settling"]
    time, attitude, rate = (node[name].number() for name in ("time", "attitude", "rate"))
    for proved, (transient, repeated) in zip(bins, covered, strict=True):
        for box in transient:
            bv = box.bv
            within = bv <= attitude and rate_above(setting, box, bv) <= rate
            require(box.stop <= time or within, f"not settled before {show(box.stop)} s")
        if not repeated:
            require(claim.has("horizon"), "a bin has no repeating part")
            continue
        period = setting.profile.period
        assert period is not None
        n = max(int((time - proved.tail[0].start) // period), 0)
        require(n <= 10**5, "the settling time is out of range")
        for periods in (n, n + 1):
            scale = proved.ratio**periods
            for box in repeated:
                bv = root_above(2 * box.S)
                within = bv * scale <= attitude and rate_above(setting, box, bv) * scale <= rate
                stop = box.stop + periods * period
                require(stop <= time or within, f"not settled before {show(stop)} s")
    end = f" up to {show(claim['horizon'].number())} s" if claim.has("horizon") else " for good"
    return [f"and |bv| <= {show(attitude)}, |w| <= {show(rate)} rad/s from t = {show(time)} s on{end}"]


def check_torque(claim: Node, covered: list[Boxes], system: Comparison) -> list[str]:
    """Check a bound of the Euclidean norm of the applied torque g u, if one is claimed."""
    if not claim.has("torque"):
        return []
    bound = claim["torque"].number()
    for transient, repeated in covered:
        for box in (*transient, *repeated):
            applied = box.g * system.command(box)
            require(applied <= bound, f"the torque is not bounded before {show(box.stop)} s")
    return [f"and |g u| <= {show(bound)} N m (Euclidean)"]
