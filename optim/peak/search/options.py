"""Options of the search: which solver, how many starts, how fine a mesh."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol, final

from ....models.types import Array
from ..solvers.scp import LocalAnswer
from ..transcription.shooting import Shooting


class LocalSolver(Protocol):
    """A method that improves a control to a local optimum on a fixed mesh."""

    @property
    def name(self) -> str:
        """Name in the record."""

    def solve(self, shooting: Shooting, control: Array, *, tolerance: float | None = None) -> LocalAnswer:
        """Local optimum from a control, or the reason for there being none."""


@final
@dataclass(frozen=True, kw_only=True)
class MultiStart:
    """How widely to search for other local optima.

    Attributes
    ----------
    starts : int
        Starts for each target sign: the plain guess, and starts - 1 random bends of it.
    seed : int
        Seed of the first bend; the others follow.
    bend : float
        Size of the bends relative to the guess.
    tolerance : float
        Of the coarse solutions.
    """

    starts: int = 4
    seed: int = 0
    bend: float = 0.4
    tolerance: float = 1e-6

    def __post_init__(self) -> None:
        if self.starts < 1:
            raise ValueError(f"starts must be >= 1, received {self.starts}")
        if self.bend < 0:
            raise ValueError(f"bend must be >= 0, received {self.bend:g}")


@final
@dataclass(frozen=True, kw_only=True)
class Refinement:
    """How finely to cut the windows.

    Attributes
    ----------
    mesh_gap : float
        Refine until the estimated gain from finer cells is below this fraction of the peak.
    cells : int
        Open cells of the coarse mesh, about (at least two in each piece of the profile).
    max_rounds : int
    step_error : float
        Largest error of one integration step, solver units.
    """

    mesh_gap: float = 1e-6
    cells: int = 36
    max_rounds: int = 10
    step_error: float = 1e-11

    def __post_init__(self) -> None:
        if not 0 < self.mesh_gap < 1:
            raise ValueError(f"mesh_gap must be in (0, 1), received {self.mesh_gap:g}")
        if self.cells < 1 or self.max_rounds < 1:
            raise ValueError("cells and max_rounds must be >= 1")
