"""The set of states over which a derivative is sampled, and the map from the unit cube onto it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.types import Array


@final
@dataclass(frozen=True, kw_only=True)
class SampledDomain:
    """Attitudes on S^3 times a box of the other variables.

    Attributes
    ----------
    rate : half-width of each component of Omega (of w, for a law without a gain), rad/s
    controller : (low, high) of every controller state, in the law's order
    gain : largest g; g is drawn from [0, gain]
    gain_rate : largest |g'|, 1/s; g' is drawn from [-gain_rate, gain_rate]
    names : names of the controller states
    """

    rate: Fraction
    controller: tuple[tuple[Fraction, Fraction], ...]
    names: tuple[str, ...]
    gain: Fraction
    gain_rate: Fraction

    def __post_init__(self) -> None:
        if self.rate <= 0 or self.gain <= 0 or self.gain_rate < 0:
            raise ValueError("the sampled domain needs rate > 0, gain > 0 and gain_rate >= 0")
        for name, (low, high) in zip(self.names, self.controller, strict=True):
            if low > high:
                raise ValueError(f"sampled domain of {name}: low {float(low):g} exceeds high {float(high):g}")

    @property
    def dimension(self) -> int:
        """Dimensions of the unit cube: three for the attitude, one for every other variable."""
        return 3 + 3 + len(self.controller) + 2

    def bounds(self) -> tuple[Array, Array]:
        """Lower and upper ends of (Omega, controller states, g, g'), (n,) each."""
        rate, gain, gain_rate = float(self.rate), float(self.gain), float(self.gain_rate)
        low = [-rate] * 3 + [float(a) for a, _ in self.controller] + [0.0, -gain_rate]
        high = [rate] * 3 + [float(b) for _, b in self.controller] + [gain, gain_rate]
        return np.array(low), np.array(high)

    def states(self, cube: Array) -> Array:
        """Map unit-cube points, (N, dimension), to rows (b0..b3, Omega, controller, g, g'), (4 + n, N)."""
        out = np.empty((self.dimension + 1, len(cube)))
        self.fill(cube.T, out)
        return out

    def fill(self, cube: Array, out: Array) -> None:
        """Map rows of unit-cube coordinates, (dimension, N), into rows of states, (4 + n, N).

        The attitude is uniform on S^3 (Shoemake's subgroup algorithm).
        """
        low, high = self.bounds()
        np.multiply(cube[3:], (high - low)[:, None], out=out[4:])
        out[4:] += low[:, None]
        # Cosine and sine from the tangent t of half the angle: one call, and a quicker one, for both;
        # (1 - t^2, 2 t)/(1 + t^2) is a unit vector to rounding whatever t.
        tangent = np.pi * cube[1:3]
        np.tan(tangent, out=tangent)
        cosine = tangent * tangent
        share = 1.0 + cosine
        np.divide(1.0, share, out=share)
        np.subtract(1.0, cosine, out=cosine)
        cosine *= share
        tangent += tangent
        tangent *= share
        inner, outer = np.sqrt(cube[0]), np.sqrt(1.0 - cube[0])
        np.multiply(inner, cosine[1], out=out[0])
        np.multiply(outer, tangent[0], out=out[1])
        np.multiply(outer, cosine[0], out=out[2])
        np.multiply(inner, tangent[1], out=out[3])

    def describe(self) -> str:
        """State the domain in words."""
        parts = [
            "all attitudes (uniform on S^3)",
            f"each |Omega_i| <= {float(self.rate):g} rad/s",
            *(
                f"{name} in [{float(a):.6g}, {float(b):.6g}]"
                for name, (a, b) in zip(self.names, self.controller, strict=True)
            ),
            f"g in [0, {float(self.gain):g}]",
            f"|g'| <= {float(self.gain_rate):.4g} 1/s",
        ]
        return ", ".join(parts)
