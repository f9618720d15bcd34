"""The sampled derivative of V for one law of a scenario: which domain, which V."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...models.schedule import Schedule
from ...scenario import Scenario
from ...verify.filter.converged import ConvergedFilter
from ...verify.filter.recognise import follows_filter
from ...verify.sampling import (
    SampledDerivative,
    SampledDomain,
    Sampling,
    derivative_function,
    interpret,
    sample_derivative,
)
from ...verify.verdict import Claim, Verdict
from ..simulated_run import RunFigures

CERTIFIED_FLOOR = "certified_floor"
"""Name of the quantity of the claim "filter.floor" that is a certified floor of R."""
GRID = 65
"""Points of a piece at which g' is looked at: the domain's size is stated, not proved."""


def sample_law(
    scenario: Scenario, law: Law, floor: Fraction | None, progress: Callable[[float], None]
) -> tuple[SampledDerivative | None, str]:
    """Sample V' over the scenario's domain; or the reason why that cannot be done."""
    try:
        function = derivative_function(close_loop(law))
    except ValueError as error:
        return None, str(error)
    if floor is None and "R" in function.loop.controller_states:
        return (
            None,
            "no positive value of R_min is known, so that k* = 1/R_min and the domain are not defined",
        )
    domain = sampled_domain(scenario, law, floor)
    weight, target = law.parameters.get("a", Fraction(1)), 1 / floor if floor else Fraction(0)
    samples = sample_derivative(
        function,
        scenario.body,
        domain,
        weight=weight,
        gain_target=target,
        sampling=Sampling(count=scenario.check.samples, seed=scenario.check.seed),
        progress=progress,
    )
    return interpret(function, scenario.body, samples, weight=weight, gain_target=target), ""


def reference_floor(scenario: Scenario, law: Law, claim: Claim | None, seen: RunFigures) -> Fraction | None:
    """R_min for V's k* = 1/R_min and for the sampled domain, s.

    The certified floor where there is one; else the converged one (periodic schedules), which bounds
    inf R from above; else the least R of the run. Any value > 0 makes a V to be examined.
    """
    if claim is not None and claim.verdict is Verdict.PROVED:
        for quantity in claim.quantities:
            if quantity.name == CERTIFIED_FLOOR and quantity.low > 0:
                return Fraction(quantity.low)
    if follows_filter(close_loop(law)) and scenario.schedule.is_periodic:
        low = ConvergedFilter(scenario.schedule, law.parameters["lambda"]).floor().low
        return Fraction(low) if low > 0 else None
    return Fraction(seen.floor) if seen.floor is not None and seen.floor > 0 else None


def sampled_domain(scenario: Scenario, law: Law, floor: Fraction | None) -> SampledDomain:
    """All attitudes; Omega, k and g as the scenario states; R from R_min to its upper bound.

    R <= max(R(0), 2 max g^2/lambda) along every run of a law whose R is the persistence filter. Any other
    controller state is drawn up to `[check] gain`, from the least value that its law states, or from -gain.
    """
    gain, gain_rate = gain_extremes(scenario.schedule)
    boxes: list[tuple[Fraction, Fraction]] = []
    names = tuple(state.name for state in law.controller_states)
    filtered = follows_filter(close_loop(law))
    for state in law.controller_states:
        if state.name == "R" and floor is not None and filtered:
            upper = max(state.initial, 2 * gain**2 / law.parameters["lambda"])
            boxes.append((floor, max(upper, floor)))
        else:
            boxes.append((-scenario.check.gain if state.least is None else state.least, scenario.check.gain))
    return SampledDomain(
        rate=scenario.check.rate, controller=tuple(boxes), names=names, gain=gain, gain_rate=gain_rate
    )


def gain_extremes(schedule: Schedule) -> tuple[Fraction, Fraction]:
    """Largest g, and largest |g'| (1/s), over the schedule, to grid accuracy."""
    shortest: dict[tuple[Fraction, ...], Fraction] = {}
    knots, shapes = schedule.profile.knots, schedule.profile.shapes
    for start, end, shape in zip(knots, knots[1:], shapes, strict=False):
        length = end - start
        if shape not in shortest or length < shortest[shape]:
            shortest[shape] = length
    gain, slope = 0.0, 0.0
    grid = np.linspace(0, 1, GRID)
    for shape, length in shortest.items():
        coefficients = np.array([float(c) for c in shape] or [0.0])
        gain = max(gain, float(np.polynomial.polynomial.polyval(grid, coefficients).max()))
        rates = np.polynomial.polynomial.polyval(grid, np.polynomial.polynomial.polyder(coefficients))
        slope = max(slope, float(np.abs(rates).max()) / float(length))
    return Fraction(gain).limit_denominator(10**9), Fraction(slope).limit_denominator(10**9)
