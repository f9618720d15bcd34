"""What can be proved of a law on bodies and thrusters that its controller does not know."""
