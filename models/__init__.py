"""What the system is: schedule, rigid body, laws, closed loop, storage functions, simulation."""
