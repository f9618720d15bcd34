"""Running a user's own code: what it raises becomes bad input, and what it prints stays out of the output."""

from __future__ import annotations

import inspect
import re
import signal
import sys
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager, redirect_stdout
from functools import wraps
from pathlib import Path
from types import FrameType
from typing import Any

from .errors import ScenarioError

_REMEDIES = (
    (("truth value of", "__bool__"), "a Python `if`, `and` or `min` cannot see a symbol: use casadi.if_else"),
    (
        ("ufunc", "no callable", "futurewarning"),
        "numpy cannot take symbols: use casadi.sin, ...",
    ),
    (("_array_", "__array__", "converting"), "numpy arrays cannot hold symbols: use casadi.vertcat"),
    (
        ("not subscriptable", "'list'", "'tuple'", "list of"),
        "build vectors with casadi.vertcat, not as lists",
    ),
    (("to_int",), "int(), range() and indices cannot take symbols: use casadi.floor or casadi.if_else"),
    (("recursion",), "a method calls itself without end"),
)
"""What the words of an error point to, and the remedy."""


def remedy(error: BaseException) -> str:
    """Name the usual cure of an error in a law's code, or an empty text."""
    said = f"{type(error).__name__} {error}".lower()
    found = (cure for words, cure in _REMEDIES if any(word.lower() in said for word in words))
    return next(found, "")


def complaint(error: BaseException, path: Path, where: str, name: str, control: str = "") -> ScenarioError:
    """Say in one line what a user's code did, where, and what cures it.

    `control`: the line of the law's `control`, named where what it returned is at fault.
    """
    if isinstance(error, SystemExit):
        said = f"it asked the program to end (sys.exit({error.code!r}))"
        cure = "raise ValueError with a reason instead"
    else:
        text = _gist(str(error))
        said, cure = f"{type(error).__name__}: {text}" if text else type(error).__name__, remedy(error)
    line = line_of(error, path) or (control if str(error).startswith("law ") else "")
    place = f"{where}: {path.name}{line}"
    return ScenarioError(place, f"{name}: {said}" + (f"; {cure}" if cure else ""))


def _gist(message: str) -> str:
    """The line of a message that says what is wrong; CasADi's begin with a place in its own source."""
    lines = [line for line in message.splitlines() if line and not line.endswith("failed:")]
    return re.sub(r"^\.\.\./\S+: ", "", next(iter(lines), message[:100])).rstrip(".")


@contextmanager
def user_code(path: Path, where: str, name: str, control: str = "") -> Iterator[None]:
    """Run code of the user's file within: SystemExit and every exception become a `ScenarioError`.

    What the code prints goes to standard error. An interrupt by the user passes through; one that the
    code raises itself does not.
    """
    try:
        with redirect_stdout(sys.stderr), _interrupts() as pressed:
            yield
    except ScenarioError:
        raise
    except KeyboardInterrupt as error:
        if pressed or threading.current_thread() is not threading.main_thread():
            raise
        raise complaint(error, path, where, name) from error
    except BaseException as error:  # whatever the user's own code does, sys.exit included
        raise complaint(error, path, where, name, control) from error


@contextmanager
def _interrupts() -> Iterator[list[int]]:
    """Signals of an interrupt that arrive within; handled as they would be without."""
    arrived: list[int] = []
    before = signal.getsignal(signal.SIGINT)
    if threading.current_thread() is not threading.main_thread() or not callable(before):
        yield arrived
        return

    def handle(number: int, frame: FrameType | None) -> object:
        arrived.append(number)
        return before(number, frame)

    signal.signal(signal.SIGINT, handle)
    try:
        yield arrived
    finally:
        signal.signal(signal.SIGINT, before)


def guard_class(law_class: type, path: Path, where: str) -> None:
    """Put every method and property that the user's file defines for a class behind `user_code`."""
    for name in PROPERTIES:
        _require_property(law_class, name, path, where)
    for owner in law_class.__mro__:
        if owner.__module__ != law_class.__module__ or "_guarded" in vars(owner):
            continue
        for name, member in list(vars(owner).items()):
            if name.startswith("__"):
                continue
            guarded = _guarded(member, path, where, law_class.__name__)
            if guarded is not None:
                setattr(owner, name, guarded)
        owner._guarded = True  # type: ignore[attr-defined]


PROPERTIES = ("parameters", "controller_states", "signals")
"""What a law tells of itself as attributes, not as methods."""


def _require_property(law_class: type, name: str, path: Path, where: str) -> None:
    """Refuse a plain method where an attribute belongs, with its line."""
    member = inspect.getattr_static(law_class, name, None)
    if callable(member) and hasattr(member, "__code__") and member.__code__.co_filename == str(path):
        raise ScenarioError(
            f"{where}: {path.name} line {member.__code__.co_firstlineno}",
            f"{law_class.__name__}.{name} is a method, and must be an attribute: write @property above it",
        )


def _guarded(member: Any, path: Path, where: str, name: str) -> Any:
    if isinstance(member, property) and member.fget is not None:
        return property(_wrapped(member.fget, path, where, name), member.fset, member.fdel, member.__doc__)
    if callable(member) and hasattr(member, "__code__"):
        return _wrapped(member, path, where, name)
    return None


def _wrapped(function: Callable[..., Any], path: Path, where: str, name: str) -> Callable[..., Any]:
    @wraps(function)
    def run(*arguments: Any, **keywords: Any) -> Any:
        with user_code(path, where, f"{name}.{function.__name__}"):
            return function(*arguments, **keywords)

    return run


def line_of_control(law_class: type, path: Path) -> str:
    """Return " line N" of a class's `control` in the user's file, or an empty text."""
    code = getattr(inspect.unwrap(getattr(law_class, "control", len)), "__code__", None)
    return f" line {code.co_firstlineno}" if code is not None and code.co_filename == str(path) else ""


def line_of(error: BaseException, path: Path) -> str:
    """Return " line N" of the user's file: the innermost one that the error passed through."""
    if isinstance(error, SyntaxError) and error.filename == str(path):
        return f" line {error.lineno}"
    line, traceback = "", error.__traceback__
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = f" line {traceback.tb_lineno}"
        traceback = traceback.tb_next
    return line
