"""What `intermit optimum` prints: the least peaks, how they were checked, where the torque switches."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..optim.peak import Standing
from ..reports.numbers import write
from ..study.optimum.record import (
    impulse_words,
    least_impulse_words,
    least_time_words,
    residuals,
    start_words,
    switch_words,
    terminal_words,
)
from ..study.optimum.result import PEAK_HEAD, peak_row
from ..study.optimum.run import final_time, idle_words
from .claim_tables import plain_table

if TYPE_CHECKING:
    from rich.console import Console

    from ..study.optimum.result import Optimum, OptimumStudy

STYLES = {Standing.CHECKED: "bold green", Standing.IMPOSSIBLE: "bold red", Standing.UNDECIDED: "bold yellow"}
MAX_SWITCHES = 12
"""Switch times printed; the record holds them all."""


def print_optimum(console: Console, study: OptimumStudy) -> None:
    """Print every least peak of a study."""
    from rich.text import Text

    scenario = study.scenario
    first = study.optima[0].problem
    console.print(f"{scenario.name} ({scenario.path.name})", style="bold")
    console.print(study.sentence)
    gain = scenario.optimum.profile == "gain"
    console.print(
        f"Start: {start_words(study.optima[0])}. End: {terminal_words(study.optima[0])}, by tf = "
        f"{float(final_time(scenario)):g} s; "
        + ("torque up to p g(t)." if gain else "full torque inside the windows.")
    )
    if scenario.clock.words:
        console.print(scenario.clock.words)
    if idle := idle_words(scenario, first):
        console.print(f"Idle time left out: {idle}.")
    console.print()
    table = plain_table(*PEAK_HEAD)
    for optimum in study.optima:
        *before, standing, local = peak_row(optimum)
        table.add_row(*before, Text(standing, style=STYLES[optimum.answer.standing]), local)
    console.print(table)
    for optimum in study.optima:
        _details(console, optimum)
        asked = study.options.least_time or study.options.least_impulse
        if asked and optimum.limit is None:
            console.print("  no limit is given for this norm: nothing to answer within it")


def _details(console: Console, optimum: Optimum) -> None:
    """Reasons, limit, residuals and switch times of one least peak."""
    answer = optimum.answer
    console.print()
    console.print(optimum.problem.norm.name.capitalize(), style="bold")
    if answer.reason:
        console.print(f"  {answer.standing.value}: {answer.reason}")
        console.print(f"  next step: {answer.next_step}")
    if optimum.hopeless is not None and optimum.hopeless.reason != answer.reason:
        console.print(f"  limit: {optimum.hopeless.reason}")
        console.print(f"  next step: {optimum.hopeless.next_step}")
    elif optimum.limit_is_refuted:
        unit = optimum.problem.norm.unit
        console.print(
            f"  limit {optimum.limit:g} {unit} is below the certified bound: no controller meets it"
        )
    elif optimum.within_limit is not None:
        unit = optimum.problem.norm.unit
        word = "is enough"
        if not optimum.within_limit:
            word = f"was not met by any transfer found: the least found needs {answer.peak:.4g} {unit}"
            word += "" if optimum.bound is None else ", the certified bound does not rule out less"
        console.print(f"  limit {optimum.limit:g} {unit} {word}")
    if optimum.least_time is not None:
        console.print(f"  {least_time_words(optimum.least_time)}")
    if optimum.least_impulse is not None:
        console.print(f"  {least_impulse_words(optimum.least_impulse)}")
    if optimum.bound is not None:
        console.print(f"  certified bound from: {optimum.bound.name}")
    if answer.history is not None:
        how = f"{answer.cells} cells, {answer.solver}" if answer.peak > 0 else "no torque is needed"
        console.print(f"  impulse {impulse_words(optimum)}; {how}")
    for residual in residuals(optimum):
        console.print(f"  {residual.label}: {write(residual, most=2).ascii}")
    if answer.switching is not None and answer.switching.switch_times:
        times = answer.switching.switch_times
        shown = ", ".join(switch_words(optimum, t, j) for t, j in times[:MAX_SWITCHES])
        more = f", and {len(times) - MAX_SWITCHES} more" if len(times) > MAX_SWITCHES else ""
        console.print(f"  switches: {shown}{more}")
