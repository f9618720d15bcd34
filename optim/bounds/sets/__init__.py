"""Sets of attitudes and momenta, and how fast a potential changes over them."""
