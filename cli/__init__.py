"""The command line: words in, words and exit codes out.

One file per command; `COMMANDS` lists them in the order of the help page. A command's file holds
one function `run`, whose arguments are its options and whose docstring is its help; what it needs
of the package it imports inside, so that `intermit --help` loads nothing heavy.
"""

from __future__ import annotations

from .app import main

__all__ = ["main"]
