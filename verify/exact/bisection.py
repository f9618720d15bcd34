"""Bisection: of an interval where something ceases to hold, and of boxes until a bound is proved."""

from __future__ import annotations

import heapq
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import count
from typing import Any, TypeVar, final

T = TypeVar("T", float, Fraction)
Bounded = TypeVar("Bounded", bound=tuple[Any, ...])

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
        A proved lower bound of the function over a given box; it must not fall when a box shrinks for the
        loop to make headway, but soundness does not need that.
    box : Box
        The box to cover.
    target : float
        Stop once this is proved.
    max_evaluations : int
        Stop after this many calls of `bound`.
    scale : tuple[float, ...], optional
        One positive length a coordinate, in which widths are compared.
    """
    evaluations = 0

    def bounded(part: Box) -> tuple[float, Box]:
        nonlocal evaluations
        evaluations += 1
        return bound(part), part

    parts = best_first(
        [bounded(box)],
        lambda worst: map(bounded, halve(worst[1], scale)),
        lambda worst: worst[0] >= target or evaluations + 2 > max_evaluations,
    )
    value = parts[0][0]
    return LowerBound(value, tuple(part for _, part in parts), evaluations, value >= target)


def best_first(
    parts: Iterable[Bounded],
    split: Callable[[Bounded], Iterable[Bounded]],
    enough: Callable[[Bounded], bool],
) -> list[Bounded]:
    """Split the part with the least bound, again and again: the one loop of branch and bound.

    Parameters
    ----------
    parts : Iterable[Bounded]
        Tuples whose first entry is a lower bound of something on them; at least one.
    split : Callable[[Bounded], Iterable[Bounded]]
        Returns the parts of a part.
    enough : Callable[[Bounded], bool]
        Whether to stop, asked of the part with the least bound.

    Returns
    -------
    list
        The parts, one with the least bound first.
    """
    tie = count()
    heap = [(part[0], next(tie), part) for part in parts]
    heapq.heapify(heap)
    while not enough(heap[0][2]):
        for part in split(heapq.heappop(heap)[2]):
            heapq.heappush(heap, (part[0], next(tie), part))
    return [part for _, _, part in heap]


def bisected(
    holds: Callable[[T], bool], low: T, high: T, *, steps: int | None = None, relative: Fraction = Fraction(0)
) -> tuple[T, T]:
    """Halve an interval between a point where something holds and one where it does not.

    Monotony only guides: the question was answered at both ends that are returned.

    Parameters
    ----------
    holds : Callable[[T], bool]
        The question.
    low, high : T
        It holds at `low` and not at `high`.
    steps : int, optional
        Most halvings; None for as many as `relative` takes.
    relative : Fraction
        Stop once the interval is no longer than this share of its upper end.
    """
    done = 0
    while done != steps and high - low > relative * high:
        middle = (low + high) / 2
        low, high = (middle, high) if holds(middle) else (low, middle)
        done += 1
    return low, high
