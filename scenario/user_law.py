"""Loading a user's own law: a Python file and the class in it."""

from __future__ import annotations

import importlib.util
import sys
from collections.abc import Iterable
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import ScenarioError, quote
from .files import read_text
from .user_code import guard_class, line_of_control, user_code

if TYPE_CHECKING:
    from ..models.closed_loop import ClosedLoop
    from ..models.laws import Law


TRIED = 32
"""States at which a torque that is no number at the target is tried."""


def load_law_class(path: Path, name: str, where: str) -> type[Law]:
    """Return the class `name` of the Python file `path`; the file's code is executed.

    Raises
    ------
    ScenarioError
        If the file cannot be read or run, has no such class, or the class is not a `Law`.
    """
    from ..models.laws import Law

    source = read_text(path, f"{where}.file: {path.name}")
    digest = sha256(f"{path.resolve()}\0{source}".encode()).hexdigest()[:16]
    module_name = f"_intermit_user_law_{digest}"
    module = sys.modules.get(module_name)
    if module is None:
        spec = importlib.util.spec_from_loader(module_name, loader=None, origin=str(path))
        assert spec is not None
        module = importlib.util.module_from_spec(spec)
        module.__file__ = str(path)
        sys.modules[module_name] = module
        try:
            with user_code(path, f"{where}.file", "cannot be run"):
                exec(compile(source, str(path), "exec"), module.__dict__)  # noqa: S102  the user's own code, on request
        except BaseException:
            del sys.modules[module_name]
            raise
    found = getattr(module, name, None)
    if not isinstance(found, type):
        raise ScenarioError(f"{where}.class", f"{path.name} has no class {quote(name)}")
    if not issubclass(found, Law):
        raise ScenarioError(
            f"{where}.class",
            f"{quote(name)} must be a subclass of intermit.models.laws.Law (a frozen dataclass)",
        )
    guard_class(found, path, f"{where}.class")
    return found


def require_sound_law(law: Law, path: Path, where: str) -> None:
    """Check what a law returns: its shapes, and that its torque is a number at the target attitude.

    Raises
    ------
    ScenarioError
        Naming file, class, what is wrong and the remedy.
    """
    import casadi as ca
    import numpy as np

    from ..models.closed_loop import close_loop

    name = type(law).__name__
    called: object = law.name  # a class of the user's may say anything
    if not isinstance(called, str) or not called.strip():
        raise ScenarioError(f"{where}: {path.name}", f"{name}.name must be a text, received {called!r}")
    with user_code(path, where, name, line_of_control(type(law), path)):
        loop = close_loop(law)
    with user_code(path, where, f"{name}.storage"):
        _require_storage(loop)
    values = [*[1.0, 0, 0, 0, 0, 0, 0], *(float(s.initial) for s in law.controller_states)]
    body = [1.0, 0, 0, 1, 0, 1] * 2
    at = (values, [1.0, 0.0] + [0.0] * (loop.time.numel() - 2), list(loop.parameter_values()), body)
    function = loop.function("torque", ca.SX(loop.control.torque))
    torque = np.array(function(*at)).ravel()
    if not np.isfinite(torque).all():
        rng = np.random.default_rng(1)
        others = rng.normal(size=(TRIED, 7))
        others[:, :4] /= np.linalg.norm(others[:, :4], axis=1)[:, None]
        found = [np.array(function([*row, *values[7:]], *at[1:])).ravel() for row in others]
        if not any(np.isfinite(u).all() for u in found):
            raise ScenarioError(
                f"{where}: {path.name}",
                f"{name}: the torque is {_numbers(torque)} N m at the target and at {TRIED} other states: "
                "float() and functions of `math` turn a symbol into nan; use casadi.sin, casadi.sqrt, ...",
            )
        raise ScenarioError(
            f"{where}: {path.name}",
            f"{name}: the torque is {_numbers(torque)} N m (0/0) at the target attitude, quaternion "
            "(1, 0, 0, 0) at rest, where it must hold the body: add a small number to what is divided by, "
            "or use casadi.if_else",
        )


def _require_storage(loop: ClosedLoop) -> None:
    """Refuse a storage function that is no expression."""
    import casadi as ca

    found: object = loop.law.storage(
        loop.plant, loop.time_symbols, loop.controller_states, loop.parameter_symbols
    )
    if found is not None and not isinstance(found, (ca.SX, ca.DM, int, float)):
        raise TypeError(
            f"must return an expression such as casadi.dot(plant.w, plant.J @ plant.w), or None; "
            f"received {type(found).__name__}"
        )


def _numbers(values: Iterable[float]) -> str:
    return "(" + ", ".join(f"{value:g}" for value in values) + ")"
