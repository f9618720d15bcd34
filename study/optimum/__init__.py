"""The optimum: least peak torque, its certified lower bounds, and the record."""
