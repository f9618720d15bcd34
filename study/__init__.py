"""Run what is asked: one case, a comparison, a sweep."""
