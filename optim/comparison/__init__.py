"""Laws on equal terms: each against the best any controller could do for the same work."""
