"""Convex programs with few unknowns and many constraints."""
