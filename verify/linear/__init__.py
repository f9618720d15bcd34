"""Stability of the linear plant through periodic windows."""
