"""The gate on reached functions tells a function that ran from one that did not."""

import ast

import reached

SOURCE = '''"""A module."""

from __future__ import annotations
from abc import abstractmethod


def called():
    """Say so."""
    return 1


def idle():
    return 2


class Thing:
    @property
    def size(self):
        return 3

    @abstractmethod
    def stated(self):
        """Only stated."""
'''


def test_marks_tell_what_ran_and_change_nothing_else():
    names = [name for name, _ in reached.functions(ast.parse(SOURCE))]
    assert names == ["called", "idle", "Thing.size"]
    scope = {"__name__": "a_module"}
    exec(reached.marked(SOURCE, "a_module.py", "a_module"), scope)  # noqa: S102
    assert (scope["called"](), scope["Thing"]().size) == (1, 3)
    assert scope["called"].__doc__ == "Say so."
    assert list(reached.table("a_module")) == [1, 0, 1]
