"""The model as heyoka expressions: compiled batch functions and Taylor integrators (extra `fast`).

heyoka may reorder sums, so results agree with CasADi's to rounding, not bit for bit.
"""

from __future__ import annotations

import importlib
import importlib.util
import operator
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from .operations import FIELD
from .walk import Program, check_operations, evaluate


class HeyokaMissingError(ImportError):
    """heyoka is not installed."""


def heyoka_available() -> bool:
    """Whether the extra `fast` is installed, without importing it."""
    return importlib.util.find_spec("heyoka") is not None


def load_heyoka() -> Any:
    """The heyoka module.

    Raises
    ------
    HeyokaMissingError
        With what to install.
    """
    if not heyoka_available():
        raise HeyokaMissingError("backend 'fast' needs heyoka: pip install 'intermit[fast]'")
    return importlib.import_module("heyoka")


def heyoka_table() -> Mapping[str, Callable[..., Any]]:
    """Operations on heyoka expressions."""
    hy = load_heyoka()
    one, zero = hy.expression(1.0), hy.expression(0.0)
    direct = (
        "sqrt",
        "exp",
        "log",
        "sin",
        "cos",
        "tan",
        "asin",
        "acos",
        "atan",
        "atan2",
        "sinh",
        "cosh",
        "tanh",
    )
    return {
        **FIELD,
        "inv": lambda x: one / x,
        "twice": lambda x: 2.0 * x,
        "sq": lambda x: x**2.0,
        "pow": operator.pow,
        "constpow": operator.pow,
        **{name: getattr(hy, name) for name in direct},
        "lt": hy.lt,
        "le": hy.lte,
        "eq": hy.eq,
        "ne": hy.neq,
        "not": lambda x: hy.select(x, zero, one),
        "and": lambda x, y: hy.select(x, hy.select(y, one, zero), zero),
        "or": lambda x, y: hy.select(x, one, hy.select(y, one, zero)),
        "fmin": lambda x, y: hy.select(hy.lt(x, y), x, y),
        "fmax": lambda x, y: hy.select(hy.gt(x, y), x, y),
        "fabs": lambda x: hy.select(hy.lt(x, zero), -x, x),
        "if_else_zero": lambda c, x: hy.select(c, x, zero),
    }


def heyoka_expressions(program: Program, arguments: Sequence[Sequence[Any]]) -> list[list[Any]]:
    """Results of a program as heyoka expressions of the given ones."""
    hy, table = load_heyoka(), heyoka_table()
    check_operations(program, table, "heyoka")
    return evaluate(program, table, arguments, lambda c: hy.expression(float(c)))
