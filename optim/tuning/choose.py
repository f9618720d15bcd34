"""Which candidates to put to an expensive condition, so that few trials find a good one that passes."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from ...models.types import Array


def least_passing(points: Array, passes: Callable[[int], bool], *, attempts: int, hint: int) -> int | None:
    """Number of the least candidate found that passes, or None; at most `attempts` are tried.

    Candidates that lie near each other mostly pass or fail together: each is expected to do what the
    nearest one tried did. Only trials decide; the expectation only orders them.

    Parameters
    ----------
    points : Array
        (m, n) candidates in the unit cube, best first.
    passes : Callable[[int], bool]
        Whether a candidate, by its number, meets the condition.
    attempts : int
        Most candidates that are tried.
    hint : int
        A candidate that may well pass; it is tried after the best one.
    """
    count, best = len(points), len(points)
    away: dict[bool, Array] = {known: np.full(count, np.inf) for known in (True, False)}
    tried = np.zeros(count, dtype=bool)
    for attempt in range(min(attempts, count)):
        number = min(hint, best) if attempt == 1 else _next(away, tried, best)
        if number is None:
            break
        if tried[number]:
            continue
        passed = passes(number)
        tried[number] = True
        distance = np.linalg.norm(points - points[number], axis=1)
        away[passed] = np.minimum(away[passed], distance)
        best = min(best, number) if passed else best
    return best if best < count else None


def _next(away: dict[bool, Array], tried: NDArray[np.bool_], best: int) -> int | None:
    """The best candidate that is expected to pass, else the one nearest to that; None if none is better."""
    pool = np.flatnonzero(~tried[:best])
    if not pool.size:
        return None
    good, bad = away[True][pool], away[False][pool]
    if not np.isfinite(good).any():  # nothing has passed: as far as can be from what failed
        return int(pool[0] if not np.isfinite(bad).any() else pool[np.argmax(bad)])
    expected = pool[good < bad]
    return int(expected[0]) if expected.size else int(pool[np.argmin(good / np.maximum(bad, 1e-12))])
