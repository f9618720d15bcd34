"""What is best: windowed optimum, certified lower bounds, comparison, tuning."""
