"""Enclosures: exact Bernstein forms, balls, the bisection loop, and proved sub- and supersolutions."""
