"""Exact and outward-rounded arithmetic: balls, Bernstein forms, bisection, rational quantities."""
