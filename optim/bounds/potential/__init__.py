"""Potentials: fitted, proved, and the least travel between attitudes that follows."""
