"""The schedule study: peak, filter floor and settling against duty cycle and period."""
