"""The comparison of laws with the optimum of their own work."""
