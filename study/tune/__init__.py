"""Tuning: the least peak a law can reach, and the trade against settling time."""
