"""The best a law can do over its own parameters, and the trade of peak torque against time."""
