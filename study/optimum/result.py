"""What an optimum study found: least peaks, their checks and certified bounds; printed or drawn."""

from __future__ import annotations

from collections import Counter
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from ...errors import InputError
from ...reports import parts
from ...reports.content.blocks import Axis, Chart
from ...reports.numbers import write
from ...reports.summary import Shown, Summary
from ...scenario import Scenario
from ..options import NormKey, OptimumOptions
from ..plots import TIME, components, draw, level
from .nominal import nominal_words

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ...optim.bounds import LowerBound
    from ...optim.peak import LeastImpulseFound, LeastTime, PeakAnswer
    from ...optim.peak.search.explain import Explanation
    from ...optim.problem import TransferProblem


@final
@dataclass(frozen=True)
class Optimum:
    """One transfer solved.

    Attributes
    ----------
    answer : the least peak found and its checks
    limit : the torque (or force) limit given for this norm, its unit, or None
    hopeless : why the limit cannot be met by any controller, or None
    bound : certified lower bound, computed apart from the answer; None where there is none
    least_time, least_impulse : within the limit; None if not asked for
    stated : the transfer as the scenario states it, which the bound is about; None where it is `problem`
    """

    problem: TransferProblem
    answer: PeakAnswer
    limit: float | None
    hopeless: Explanation | None
    bound: LowerBound | None = None
    least_time: LeastTime | None = None
    least_impulse: LeastImpulseFound | None = None
    stated: TransferProblem | None = None

    @property
    def key(self) -> str:
        """Word of the norm, in options and in the record."""
        return self.problem.norm.key

    @property
    def gap(self) -> float | None:
        """(peak found - certified bound) / peak found; None without both."""
        if self.bound is None or self.answer.history is None or self.answer.peak <= 0:
            return None
        return 1.0 - self.bound.value / self.answer.peak

    @property
    def limit_is_refuted(self) -> bool:
        """Whether the limit lies below the certified bound: then no controller whatever can meet it."""
        return self.limit is not None and self.bound is not None and self.limit < self.bound.value

    @property
    def within_limit(self) -> bool | None:
        """Whether the history found respects the limit; None without a limit or a history."""
        return None if self.limit is None or self.answer.history is None else self.answer.peak <= self.limit

    @property
    def _limit_is_ruled_out(self) -> bool:
        return self.limit_is_refuted or (self.hopeless is not None and self.hopeless.certain)

    @property
    def outcome(self) -> str:
        """What became of it, in a few words: the standing, and the limit if there is one."""
        from ...optim.peak import Standing

        if self.answer.standing is Standing.IMPOSSIBLE:
            return "impossible"
        if self._limit_is_ruled_out:
            return "impossible within its limit"
        if self.answer.standing is Standing.UNDECIDED:
            return "left open"
        return "found and checked" + (" but above its limit" if self.within_limit is False else "")

    @property
    def exit_code(self) -> int:
        """0 solved (and within the limit), 1 impossible, 3 left open."""
        from ...optim.peak import Standing

        if self.answer.standing is Standing.IMPOSSIBLE or self._limit_is_ruled_out:
            return 1
        if self.answer.standing is Standing.UNDECIDED or self.within_limit is False:
            return 3
        return 0


@final
@dataclass(frozen=True, repr=False)
class OptimumStudy(Shown):
    """Every transfer of a scenario, solved.

    Attributes
    ----------
    scenario, options : what was asked
    optima : one a norm, in the order asked for
    """

    scenario: Scenario
    options: OptimumOptions
    optima: tuple[Optimum, ...]

    @property
    def exit_code(self) -> int:
        """1 if one is impossible, else 3 if one is left open, else 0."""
        codes = {optimum.exit_code for optimum in self.optima}
        return 1 if 1 in codes else 3 if 3 in codes else 0

    @property
    def sentence(self) -> str:
        """The outcome in one sentence."""
        counts = Counter(optimum.outcome for optimum in self.optima)
        parts = [f"{n} {words}" for words, n in counts.items()]
        body = nominal_words(self.scenario)
        spoken = f" Optima and bounds are {body}." if body else ""
        return f"Of {len(self.optima)} least peaks: {'; '.join(parts)}.{spoken}"

    def optimum(self, norm: NormKey) -> Optimum:
        """The optimum in one norm.

        Raises
        ------
        InputError
            If that norm was not asked for.
        """
        for found in self.optima:
            if found.key == norm:
                return found
        raise InputError(f"no optimum in the norm {norm!r} (solved: {', '.join(o.key for o in self.optima)})")

    @property
    def summary(self) -> Summary:
        """The least peaks found beside their certified bounds, as `intermit optimum` prints them."""
        why = [f"{o.problem.norm.name}: {o.answer.reason}" for o in self.optima if o.answer.reason]
        table = (PEAK_HEAD, [peak_row(optimum) for optimum in self.optima])
        title = f"{self.scenario.name} ({self.scenario.path.name})"
        return Summary(title, (self.sentence, *why), (table,))

    def plot(self) -> NDArray[np.object_]:
        """Draw the torque of each least-peak history, N m over s, with its peak; matplotlib axes, (found,).

        Raises
        ------
        InputError
            If no history was found in any norm.
        """
        charts = [chart for optimum in self.optima if (chart := _chart(optimum)) is not None]
        if not charts:
            raise InputError("nothing to draw: no transfer was found")
        return draw(charts)


PEAK_HEAD = ("Least peak", "certified >=", "found", "gap", "standing", "local optima")


def peak_row(optimum: Optimum) -> tuple[str, ...]:
    """One least peak as a row under `PEAK_HEAD`."""
    answer, unit = optimum.answer, optimum.problem.norm.unit
    return (
        optimum.problem.norm.name,
        _bound(optimum),
        f"{answer.peak:.7g} {unit}" if answer.history is not None else "-",
        "-" if optimum.gap is None else f"{100 * max(0.0, optimum.gap):.3g} %",
        answer.standing.value,
        _local_optima(optimum),
    )


def _bound(optimum: Optimum) -> str:
    """The certified bound, rounded down."""
    if optimum.bound is None:
        return "-"
    unit = optimum.problem.norm.unit
    lower = parts.quantity("bound", optimum.bound.value, unit=unit, rigorous=True, side="lower")
    return write(lower).ascii.removeprefix(">= ")


def _local_optima(optimum: Optimum) -> str:
    """Count of distinct local optima among the starts, and their spread."""
    search = optimum.answer.search
    found = search.local_optima
    if not found:
        return "-"
    if len(found) == 1:
        return f"1 from {len(search.starts)} starts"
    return f"{len(found)} from {len(search.starts)} starts, worst +{100 * search.spread:.3g} %"


def _chart(optimum: Optimum) -> Chart | None:
    """Torque over time with the levels that matter; forces are drawn as the torque they make."""
    history = optimum.answer.history
    if history is None:
        return None
    edges, unit = history.edges, optimum.problem.norm.unit
    shaded = [(float(edges[k]), float(edges[k + 1])) for k in np.flatnonzero(history.open)]
    t = np.unique(np.r_[np.linspace(edges[0], edges[-1], 2001), edges])
    lines = components(t, history.torque(t))
    title = f"Least peak, {optimum.problem.norm.name}: {history.peak:.6g} {unit}"
    if unit == "N m":
        lines += (level("peak", t, history.peak, 3),)
    return Chart(optimum.key, title, TIME, Axis("torque", "N m"), lines, "", tuple(shaded))
