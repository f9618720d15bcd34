"""The one bisection loop: prove a bound on a box by halving where it is not yet proved."""

from __future__ import annotations

import heapq
from collections.abc import Callable
from dataclasses import dataclass
from itertools import count
from typing import final

Box = tuple[tuple[float, float], ...]
"""One (low, high) pair a coordinate."""


@final
@dataclass(frozen=True)
class LowerBound:
    """Result of `minimum_below`.

    Attributes
    ----------
    value : float
        A proved lower bound of the function over the whole box (if `bound` is rigorous).
    boxes : tuple of Box
        A cover of the box, each with a proved bound >= `value`: the witness.
    evaluations : int
        Number of boxes bounded.
    complete : bool
        Whether the target was reached before the evaluations ran out.
    """

    value: float
    boxes: tuple[Box, ...]
    evaluations: int
    complete: bool


def halve(box: Box, scale: tuple[float, ...] | None = None) -> tuple[Box, Box]:
    """Halve the box across its widest coordinate, widths measured in units of `scale`."""
    weights = scale or (1.0,) * len(box)
    axis = max(range(len(box)), key=lambda i: (box[i][1] - box[i][0]) / weights[i])
    low, high = box[axis]
    middle = (low + high) / 2
    return (
        (*box[:axis], (low, middle), *box[axis + 1 :]),
        (*box[:axis], (middle, high), *box[axis + 1 :]),
    )


def minimum_below(
    bound: Callable[[Box], float],
    box: Box,
    *,
    target: float,
    max_evaluations: int,
    scale: tuple[float, ...] | None = None,
) -> LowerBound:
    """Lower bound of a function over `box`, halving the worst box until `target` is reached.

    Parameters
    ----------
    bound : callable
        A proved lower bound of the function over a given box; it must not fall when a box shrinks
        for the loop to make headway, but soundness does not need that.
    box : the box to cover
    target : stop once this is proved
    max_evaluations : stop after this many calls of `bound`
    scale : one positive length a coordinate, in which widths are compared
    """
    tie = count()
    heap = [(bound(box), next(tie), box)]
    evaluations = 1
    while heap[0][0] < target and evaluations + 2 <= max_evaluations:
        _, _, worst = heapq.heappop(heap)
        for half in halve(worst, scale):
            heapq.heappush(heap, (bound(half), next(tie), half))
        evaluations += 2
    return LowerBound(heap[0][0], tuple(b for _, _, b in heap), evaluations, heap[0][0] >= target)
