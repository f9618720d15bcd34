"""The transfer that a bound of the peak speaks about."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .body import read_inertia
from .exact_numbers import Matrix, Vector, require, show
from .matrices import show_matrix
from .peak_numbers import image, require_short
from .peak_window import PeakWindow
from .reading import Node


@dataclass(frozen=True)
class Transfer:
    """What a bound of the peak speaks about."""

    J: Matrix
    window: PeakWindow
    attitude: Vector
    rate: Vector
    tolerance: Fraction
    end_rate: Fraction
    signs: Vector
    torques: list[Vector] | None
    words: str
    unit: str

    @classmethod
    def read(cls, data: Node) -> Transfer:
        """Read and check the transfer of the data."""
        require_short([x for row in data["inertia"].matrix(3, 3) for x in row], "inertia")
        J, place = read_inertia(data), data["transfer"]
        torques, words, unit = read_torques(place["torque"])
        q, w, signs = (
            place["attitude"].vector(4),
            place["rate"].vector(3),
            place["signs"].vector(),
        )
        require(any(q), "the start attitude must not be zero")
        require(signs in ([1], [-1], [1, -1], [-1, 1]), "target signs are +1, -1 or both")
        tolerance, end_rate = (place["tolerance"][name].number() for name in ("attitude", "rate"))
        require(0 <= tolerance < 1, "the terminal tolerance must lie in [0, 1)")
        require(end_rate >= 0, "the terminal rate tolerance must not be negative")
        window = PeakWindow.read(place["window"])
        return cls(J, window, q, w, tolerance, end_rate, signs, torques, words, unit)

    @property
    def momentum(self) -> Vector:
        """J w at the start."""
        return image(self.J, self.rate)

    def describe(self) -> list[str]:
        """Return the transfer for people."""
        ends = " or ".join(f"{int(x):+d}" for x in self.signs)
        return [
            f"inertia J = {show_matrix(self.J)} kg m^2,",
            f"transfer time {show(self.window.knots[-1])} s, integral of the window profile "
            f"{show(self.window.first[-1])} s,",
            f"start quaternion along ({', '.join(show(c) for c in self.attitude)}),",
            f"start rate ({', '.join(show(c) for c in self.rate)}) rad/s, target quaternion {ends},",
            f"terminal tolerance |bv| <= {show(self.tolerance)}, |w| <= {show(self.end_rate)} rad/s;",
        ]


def read_torques(place: Node) -> tuple[list[Vector] | None, str, str]:
    """Return points whose convex hull holds the torques of unit peak (None: the ball), words and unit."""
    by = place["by"].text()
    if by == "euclidean":
        return None, "|torque(t)| <= p w(t)", "N m"
    signs = [Fraction(1), Fraction(-1)]
    if by == "component":
        cube = [[a, b, c] for a in signs for b in signs for c in signs]
        return cube, "every |torque_i(t)| <= p w(t)", "N m"
    require(by == "thrusters", "torque is limited by euclidean, component or thrusters")
    axes = place["axes"].matrix(None, 3)
    require(0 < len(axes) <= 12, "expected 1 to 12 thrusters")
    sums: list[Vector] = [[Fraction(0)] * 3]
    for axis in axes:
        sums += [[x + y for x, y in zip(point, axis, strict=True)] for point in sums]
    return sums, f"torque = B f, 0 <= f_j <= p w(t), columns of B {show_matrix(axes)} m,", "N"
