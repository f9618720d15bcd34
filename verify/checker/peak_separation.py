"""The travel from start to target, by angle or by potential."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

from .exact_numbers import Vector, require, show
from .peak_chart import PeakChart, cubic_scale, largest_near, rate_polynomials
from .peak_gauge import Gauge
from .peak_numbers import (
    PEAK_DEGREE,
    PI,
    Cubic,
    arctangent_above,
    arctangent_below,
    length_interval,
    root_interval,
)
from .peak_rate import RateProof
from .peak_transfer import Transfer
from .reading import Node


def travel_by_angle(q: Vector, arc: Fraction, speed: Fraction) -> Fraction:
    """Travel from the angle alone: twice the arc left outside the tolerance, over the fastest rate."""
    low, high = length_interval(q)
    vector = length_interval(q[1:])
    if q[0] >= 0:
        reached = 2 * arctangent_below(vector[0] / (high + q[0]))
    else:
        reached = PI[0] - 2 * arctangent_above(vector[1] / (low - q[0]))
    return 2 * (reached - arc) / speed


@dataclass(frozen=True)
class PeakTarget:
    """Terminal tolerance as an arc and as a chord of the sphere of quaternions, rounded up."""

    arc: Fraction
    chord: Fraction

    @classmethod
    def of(cls, radius: Fraction) -> PeakTarget:
        """Targets |bv| <= radius."""
        require(0 <= radius < 1, "the terminal tolerance must lie in [0, 1)")
        if radius == 0:
            return cls(Fraction(0), Fraction(0))
        cosine = root_interval(1 - radius**2)[0]
        require(cosine > 0, "the terminal tolerance is too large")
        return cls(radius / cosine, root_interval(2 - 2 * cosine)[1])

    def radius(self, x: Vector) -> Fraction:
        """Upper bound of the distance in the chart from x to any target around it."""
        size = length_interval(x)[1]
        require(size + self.chord <= 1, "the terminal tolerance is too large for the chart")
        reach = self.chord
        for _ in range(3):
            reach = min(reach, self.chord * root_interval((1 + size**2) * (1 + (size + reach) ** 2))[1] / 2)
            reach = Fraction(math.ceil(reach * 2**60), 2**60)
        return reach


def read_potential(place: Node) -> Cubic:
    """Read a polynomial of three variables: rows of three exponents and a coefficient."""
    phi: Cubic = {}
    for entry in place.items():
        i, j, k, c = entry.vector(4)
        sound = all(x.denominator == 1 and x >= 0 for x in (i, j, k)) and i + j + k <= PEAK_DEGREE
        require(sound, f"exponents must be integers of sum at most {PEAK_DEGREE}")
        exponent = (int(i), int(j), int(k))
        require(exponent not in phi and any(exponent), "a term of the potential is constant or given twice")
        phi[exponent] = c
    require(bool(phi), "the potential has no terms")
    return phi


def require_separation(
    place: Node, gauge: Gauge, speed: Fraction, q: Vector, target: PeakTarget, travel: Fraction
) -> str:
    """Prove that every motion from q to the quaternion +1 travels at least `travel`."""
    if place["by"].text() == "angle":
        enough = travel_by_angle(q, target.arc, speed) >= travel
        require(enough, "the rotation angle does not give the travel")
        return "by the rotation angle"
    require(place["by"].text() == "potential", "a separation is by angle or by potential")
    chart, phi = PeakChart(place["chart"]), read_potential(place["potential"])
    rate = place["rate"].number()
    require(rate > 0, "the rate must be positive")
    start, error = chart.locate(q)
    end = [-c for c in chart.middle]
    slack = chart.arc_to_model(start, 1) + 4 * error + chart.arc_to_model(end, -1) + target.arc
    reach = 2 * (4 * arctangent_below(chart.outer) - slack) / speed
    require(reach >= travel, "a path of that travel may leave the region")
    t = chart.outer
    high = largest_near(phi, [c / t for c in end], target.radius(end) / t)
    low = -largest_near(cubic_scale(phi, Fraction(-1)), [c / t for c in start], 2 * error / t)
    require(low - high >= travel * rate, "the potential does not differ enough between start and target")
    count = RateProof(gauge, rate).run(rate_polynomials(phi, gauge.inverse, t), chart.region())
    return f"by a potential of degree {max(sum(e) for e in phi)}, proved on {count} boxes"


def require_travel(d: Transfer, gauge: Gauge, speed: Fraction, travel: Fraction, witness: Node) -> str:
    """Prove the travel to every quaternion of the target."""
    require(travel > 0 and speed > 0, "travel and speed must be positive")
    target, found = PeakTarget.of(d.tolerance), witness["separations"].items()
    require(len(found) == len(d.signs), "one separation for each target sign")
    words = []
    for sign, place in zip(d.signs, found, strict=True):
        q = [sign * c for c in d.attitude]
        words.append(require_separation(place, gauge, speed, q, target, travel))
    return f"travel at least {show(travel)} s in the gauge of {len(gauge.rows)} rows: " + "; ".join(words)
