"""Checks of an answer, recomputed outside every solver."""
