"""From a transfer to equations on a mesh: cells, steps, states, terminal residual."""
