"""Searches over starts and meshes: least peak, least impulse, least time."""
