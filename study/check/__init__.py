"""The check: every claim about every law of a scenario, and its record."""
