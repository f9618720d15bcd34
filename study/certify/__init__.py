"""Certificate files of a scenario's claims."""
