"""Is it true: verdicts, conditions, sampling, enclosures, certificates."""
