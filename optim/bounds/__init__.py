"""Certified lower bounds of the peak torque through windows."""

from .argument import NamedBound
from .bound import LowerBound, certified_lower_bound
from .potential.path import PathOptions

__all__ = ["LowerBound", "NamedBound", "PathOptions", "certified_lower_bound"]
