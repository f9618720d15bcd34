"""Prove that the initial set settles sooner: refine the bin that settles last.

Bins are chosen for the floor of R, and a bin's tail begins as soon as the floor allows. For the
settling time both are coarse: over a wide bin k is known to learn only what its least start
learns, and an early tail shrinks at the ratio of its first period, in which the rate still feeds
the angle. Two moves help, each again a proved witness: a later tail, or two halves of the bin.
"""

from __future__ import annotations

from dataclasses import replace

from .certify import FilterLowerBound, FloorOptions, FloorProof, halved
from .convergence import settling
from .flowpipe import Flowpipe

LATER = 3
"""Periods by which a tail is moved at a time."""
WORTH = 0.98
"""A later tail must lower the bin's settling time to this share of it, or the bin is halved instead."""


def tighten_settling_time(
    floor: FilterLowerBound, *, attitude: float, rate: float, options: FloorOptions | None = None
) -> FilterLowerBound:
    """Return a floor of the same set, no lower, whose last bin settles no later.

    Parameters
    ----------
    floor : FilterLowerBound
        What is refined.
    attitude, rate : float
        Tolerances on |bv| and on |w|, rad/s.
    options : FloorOptions, optional
        How hard to try; its defaults without one.
    """
    options, period = options or FloorOptions(), floor.schedule.period
    if period is None or floor.horizon is not None or len(floor.flowpipes) < 2:
        return floor
    proof = FloorProof(floor.system, floor.schedule, None, options)

    def time(flowpipe: Flowpipe) -> float:
        return settling(flowpipe, floor, attitude=attitude, rate=rate)

    flowpipes = list(floor.flowpipes)
    for _ in range(options.settling_moves):
        worst = max(flowpipes, key=time)
        better = _later(proof, worst)
        if not _is_proved(better, floor) or max(map(time, better)) > WORTH * time(worst):
            better = _halves(proof, worst, floor)
        if not _is_proved(better, floor) or max(map(time, better)) > time(worst):
            break
        flowpipes = [w for w in flowpipes if w is not worst] + better
    return replace(floor, flowpipes=tuple(flowpipes))


def _is_proved(flowpipes: list[Flowpipe], floor: FilterLowerBound) -> bool:
    """Whether there are any, all for all time, and none below the floor."""
    return bool(flowpipes) and all(w.tail is not None and w.floor >= floor.value for w in flowpipes)


def _later(proof: FloorProof, flowpipe: Flowpipe) -> list[Flowpipe]:
    """The same bin with its tail moved on."""
    assert flowpipe.tail is not None
    assert proof.schedule.period is not None
    start = flowpipe.tail.start + LATER * proof.schedule.period
    return [proof.complete(Flowpipe(proof.system, flowpipe.initial, flowpipe.steps), start)]


def _halves(proof: FloorProof, flowpipe: Flowpipe, floor: FilterLowerBound) -> list[Flowpipe]:
    """Both halves of the bin, with tails no earlier than its own; none of a bin that is a point."""
    assert flowpipe.tail is not None
    halves = halved(flowpipe.initial, proof.weight(floor.bounds))
    if len(halves) == 1:
        return []
    return [proof.complete(proof.early(half, proof.early_end), flowpipe.tail.start) for half in halves]
