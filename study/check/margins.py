"""How far the schedule and lambda may move while a law's convergence stays certified.

Every value is tried by the certificate itself (R_min > 0 for ever, from the whole initial set),
so each number is one up to which the claim is proved, not an estimate of where it fails.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import replace
from fractions import Fraction

from ...models.laws import Law
from ...models.schedule import Schedule, longer_gap, missing_in_a_row, shifted_edges
from ...scenario import LawChoice, Scenario
from ...verify.exact.margin_search import greatest_certified, most_certified
from ...verify.schedule.zero_runs import longest_zero_run
from ...verify.verdict import Claim, Quantity

Certified = Callable[[Law, Schedule], bool]

MAX_MISSED = 8
"""Windows in a row beyond which no further miss is tried."""
MAX_GAP = 32
"""Times its length to which the longest gap is stretched at most."""
MIN_LAMBDA = Fraction(1, 16)
"""Fraction of lambda below which no smaller lambda is tried."""


def with_margins(claim: Claim, quantities: tuple[Quantity, ...]) -> Claim:
    """Put margins under a claim."""
    return replace(claim, margins=(*claim.margins, *quantities))


def convergence_margins(scenario: Scenario, choice: LawChoice, certified: Certified) -> Iterator[Quantity]:
    """Margins of convergence in the user's own numbers.

    Yields
    ------
    Quantity
        Longest gap between windows, windows in a row that may be missed again and again, how much earlier
        every window may close, least lambda: each certified, or left out where nothing was.
    """
    law, schedule = choice.build(), scenario.schedule
    run = longest_zero_run(schedule)
    if schedule.is_periodic and run is not None:
        at, gap = run.on, run.length
        found = greatest_certified(
            lambda extra: certified(law, longer_gap(schedule, at, extra)),
            gap / 2,
            limit=gap * MAX_GAP,
            steps=3,
        )
        if found.certified:
            longest = replace(found, certified=found.certified + gap)
            yield longest.quantity(
                "longest_gap_certified", "s", "longest gap between windows, certified up to"
            )
        missed = most_certified(lambda n: certified(law, _missing(schedule, n)), MAX_MISSED)
        label = "windows in a row that may be missed again and again"
        yield missed.quantity("missed_certified", "", label)
    shortest = min(w.length for w in schedule.windows)
    cut = greatest_certified(
        lambda x: certified(law, shifted_edges(schedule, close_earlier=x)),
        shortest / 8,
        limit=shortest * 7 / 8,
    )
    if cut.certified:
        yield cut.quantity("earlier_closing", "s", "every window may close earlier by")
    yield from _least_lambda(choice, schedule, certified)


def _missing(schedule: Schedule, count: int) -> Schedule:
    """In every cycle the first `count` windows missed, in the shortest cycle that keeps one."""
    return missing_in_a_row(schedule, count, cycles=count // len(schedule.windows) + 1)


def _least_lambda(choice: LawChoice, schedule: Schedule, certified: Certified) -> Iterator[Quantity]:
    """Least lambda for which convergence was certified."""
    given = dict(choice.parameters).get("lambda")
    if given is None:
        return
    found = greatest_certified(
        lambda drop: certified(choice.with_parameters(**{"lambda": given - drop}).build(), schedule),
        given / 2,
        limit=given * (1 - MIN_LAMBDA),
        steps=2,
    )
    if found.certified:
        least = float(given - found.certified)
        label = "least lambda for which convergence was certified"
        yield Quantity("least_lambda_certified", 0.0, least, "1/s", label, rigorous=True, side="upper")
