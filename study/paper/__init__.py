"""The paper's own matter: audit of its equations, its figures, its statements."""
