"""Two solvers of one mesh: sequential convex programming and direct collocation."""
