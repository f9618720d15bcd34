"""Certified lower bounds of the peak torque through windows."""
