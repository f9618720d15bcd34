"""The floor of the filter state R, its error-angle, rate and torque bounds, certified."""
