"""Thruster schedules as exact piecewise polynomials of time."""

from .clock import Clock
from .measured import ThrustSample, measured_schedule
from .piecewise import Piece, PiecewisePolynomial
from .profiles import Hermite, Ramps, Shape, build_schedule
from .schedule import Schedule, Window
from .variants import (
    longer_gap,
    missing_in_a_row,
    shifted_edges,
    starting_at,
    unrolled,
    without_windows,
)

__all__ = [
    "Clock",
    "Hermite",
    "Piece",
    "PiecewisePolynomial",
    "Ramps",
    "Schedule",
    "Shape",
    "ThrustSample",
    "Window",
    "build_schedule",
    "longer_gap",
    "measured_schedule",
    "missing_in_a_row",
    "shifted_edges",
    "starting_at",
    "unrolled",
    "without_windows",
]
