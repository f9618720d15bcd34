"""Thruster schedules as exact piecewise polynomials of time."""

from .clock import Clock
from .piecewise import Piece, PiecewisePolynomial
from .profiles import Hermite, Ramps, Shape, build_schedule
from .schedule import Schedule, Window

__all__ = [
    "Clock",
    "Hermite",
    "Piece",
    "PiecewisePolynomial",
    "Ramps",
    "Schedule",
    "Shape",
    "Window",
    "build_schedule",
]
