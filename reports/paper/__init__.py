"""For the paper: booktabs tables, vector figures, pgfplots sources, and one article that shows them all."""

from .kit import paper_files as paper_files
