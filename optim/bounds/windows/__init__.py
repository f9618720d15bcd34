"""What torque through the windows can do: travel, coasts, deviations, components."""
