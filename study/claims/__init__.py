"""Claims by key, how they are counted, and how a record writes them."""
