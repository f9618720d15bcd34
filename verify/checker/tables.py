"""What the checker knows: kinds of certificates and comparison systems; its own, and of parts named outright.

A part is a Python file of somebody else's. It is read only when it is named, its entries are kept apart from
the checker's own, may not take their names, and every finding that used one says so.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from dataclasses import dataclass, field
from hashlib import sha256
from types import ModuleType
from typing import Any


@dataclass(frozen=True)
class Part:
    """One set of entries; `title` is empty for the checker's own.

    Attributes
    ----------
    module : a part's own module; None for the checker's own
    kinds : name of a kind -> its check
    systems : name of a comparison system -> its class
    """

    title: str
    module: ModuleType | None = None
    kinds: dict[str, Any] = field(default_factory=dict)
    systems: dict[str, Any] = field(default_factory=dict)


OWN = Part("")
_FILLED: ContextVar[Part] = ContextVar("part that is filled", default=OWN)
_NAMED: ContextVar[tuple[Part, ...]] = ContextVar("parts named", default=())


def enter(table: str, name: str, entry: Any) -> None:
    """Put an entry into a table of the part that is being read."""
    part = _FILLED.get()
    known = getattr(part, table)
    if part is not OWN and name in (*known, *getattr(OWN, table)):
        raise ValueError(f"{part.title}: the checker has an entry {name!r} already")
    known[name] = entry


def entries(table: str) -> Iterator[tuple[str, Any, str]]:
    """(name, entry, title of its part) of a table: the checker's own, then of the parts named."""
    for part in (OWN, *_NAMED.get()):
        for name, entry in getattr(part, table).items():
            yield name, entry, part.title


@contextmanager
def using(parts: tuple[Part, ...]) -> Iterator[None]:
    """Let the parts' entries count within."""
    token = _NAMED.set(parts)
    try:
        yield
    finally:
        _NAMED.reset(token)


def read_part(source: str, name: str) -> Part:
    """Run a part's Python source, which enters what it brings; `from checker import ...` is this checker.

    Raises
    ------
    ValueError
        If it brings nothing, or an entry takes a name of the checker's own.
    """
    digest = sha256(source.encode()).hexdigest()
    module = ModuleType(f"checker_part_{digest[:16]}")
    module.__file__ = name
    part = Part(f"{name}, sha256 {digest[:16]}", module)
    token, before = _FILLED.set(part), sys.modules.get("checker")
    sys.modules["checker"] = sys.modules[__name__.rpartition(".")[0]]
    sys.modules[module.__name__] = module
    try:
        exec(compile(source, name, "exec"), module.__dict__)  # noqa: S102 (named outright by the user)
    finally:
        _FILLED.reset(token)
        if before is None:
            del sys.modules["checker"]
        else:
            sys.modules["checker"] = before
    if not part.kinds and not part.systems:
        raise ValueError(f"{name} brings neither a comparison system nor a kind of certificate")
    return part
