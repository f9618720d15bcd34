"""What is true of a schedule, decided in exact rationals: order, smoothness, gaps, excitation."""
