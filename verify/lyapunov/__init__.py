"""Lyapunov functions: identities, conditions on lambda, certified decay of a storage function."""
