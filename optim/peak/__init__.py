"""Least peak torque through the windows: transcription, two solvers, verification, multi-start."""
