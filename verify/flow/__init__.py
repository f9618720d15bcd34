"""Proved flows: comparison steps of differential inequalities, and one run enclosed in balls."""
