"""Certified lower bounds of the peak torque through windows."""

from .bound import LowerBound, NamedBound, certified_lower_bound
from .path import PathOptions

__all__ = ["LowerBound", "NamedBound", "PathOptions", "certified_lower_bound"]
