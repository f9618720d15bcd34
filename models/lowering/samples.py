"""The choice of backend for many samples."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from .arrays import ArrayFunction
from .blocks import BlockFunction
from .walk import Program

Backend = Literal["default", "fast"]


def sample_function(
    program: Program, *, uniform: Sequence[int] = (), backend: Backend = "default"
) -> BlockFunction:
    """A program over many samples.

    Parameters
    ----------
    program : Program
        From `walk`, best passed through `shared`.
    uniform : sequence of int
        Arguments that hold one set of numbers for all samples.
    backend : "default" or "fast"
        numpy, bit-identical to CasADi; or heyoka (extra `fast`), equal to rounding.

    Raises
    ------
    HeyokaMissingError
        If "fast" is asked for and heyoka is not installed.
    """
    if backend == "default":
        return ArrayFunction(program, uniform=uniform)
    if backend == "fast":
        from .heyoka_functions import HeyokaFunction

        return HeyokaFunction(program, uniform=uniform)
    raise ValueError(f"backend must be 'default' or 'fast', received {backend!r}")
