"""What the paper says of its own figures, as checks on runs.

Ram & Akella, AAS 21-402, simulation section: the proposed controller has "much lower spikes in
the torque values in the transient but has higher values of torque ... at later instants"; a
higher gamma gives quicker performance and higher initial peaks; R "eventually converges to the
same value for all the cases". Each is an observation on simulated runs: it holds for the initial
data it was seen with, and is no theorem.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from ...models.ensemble import MetricOptions, simulate_ensemble
from ...models.laws import AdaptiveScaling, PersistenceFilter
from ...models.mission import Mission
from ...models.norms import LARGEST_COMPONENT
from ...optim.comparison.measure import LawRun

CONVERGED = 1e-3
"""R has converged if the runs agree to this, relative, over the last period."""


@final
@dataclass(frozen=True)
class Statement:
    """One statement of the paper on one set of runs.

    Attributes
    ----------
    holds : whether it is true of these runs
    detail : the numbers it rests on
    """

    key: str
    says: str
    holds: bool
    detail: str


def statements(slow: LawRun, fast: LawRun, reference: LawRun) -> tuple[Statement, ...]:
    """Check the paper's statements on three runs of one mission.

    Parameters
    ----------
    slow, fast : LawRun
        Adaptive scaling with the smaller and the larger gamma.
    reference : LawRun
        The persistence-filter law.
    """
    return (
        _lower_in_transient(slow, reference),
        _higher_later(slow, reference),
        _gamma_raises_peak(slow, fast),
        _gamma_settles_sooner(slow, fast),
        _same_filter((slow, fast, reference)),
    )


def _lower_in_transient(slow: LawRun, reference: LawRun) -> Statement:
    a, b = slow.peak(LARGEST_COMPONENT), reference.peak(LARGEST_COMPONENT)
    return Statement(
        "lower_in_transient",
        "adaptive peak torque below the persistence filter's in the transient",
        a < b,
        f"{a:.4g} N m against {b:.4g} N m",
    )


def _higher_later(slow: LawRun, reference: LawRun) -> Statement:
    """Whether in some later window the adaptive law's largest torque is the larger."""
    schedule, end = slow.mission.schedule, slow.mission.horizon
    for window in schedule.windows_between(schedule.windows[0].off, end):
        t = np.linspace(float(window.on), min(float(window.off), float(end)), 400)
        a, b = (
            float(LARGEST_COMPONENT.peak(run.trajectory.signals(t).applied_torque.T).max())
            for run in (slow, reference)
        )
        if a > b:
            detail = f"from the window at {float(window.on):g} s: {a:.3g} N m against {b:.3g} N m"
            return Statement("higher_later", _LATER, True, detail)
    return Statement("higher_later", _LATER, False, "in no later window")


_LATER = "adaptive torque above the persistence filter's later"


def _gamma_raises_peak(slow: LawRun, fast: LawRun) -> Statement:
    a, b = slow.peak(LARGEST_COMPONENT), fast.peak(LARGEST_COMPONENT)
    says = "larger gamma gives higher peaks"
    return Statement("gamma_peak", says, b > a, f"{a:.4g} N m, then {b:.4g} N m")


def _gamma_settles_sooner(slow: LawRun, fast: LawRun) -> Statement:
    says = "larger gamma settles faster"
    if fast.figures.settling is None or slow.figures.settling is None:
        both = fast.figures.settling is not None
        return Statement("gamma_settling", says, both, "a run does not settle within the horizon")
    detail = f"{slow.figures.settling:.4g} s, then {fast.figures.settling:.4g} s"
    return Statement("gamma_settling", says, fast.figures.settling < slow.figures.settling, detail)


def _same_filter(runs: Sequence[LawRun]) -> Statement:
    end = runs[0].trajectory.end
    period = runs[0].mission.schedule.period
    t = np.linspace(end - float(period if period is not None else end / 8), end, 400)
    R = np.array([run.trajectory.controller_state("R", t) for run in runs])
    spread = float(((R.max(axis=0) - R.min(axis=0)) / R.max(axis=0)).max())
    says = "R converges to the same value in all cases"
    detail = f"spread {spread:.1e} of R over the last period to {end:g} s"
    return Statement("same_filter", says, spread < CONVERGED, detail)


@final
@dataclass(frozen=True)
class StartData:
    """One choice of what the paper leaves unstated: angle about (1,1,1), rate and controller data."""

    angle_deg: float
    rate: float
    decay: float
    R0: float
    k0: float


@final
@dataclass(frozen=True)
class Survey:
    """How often a statement holds over many choices of the unstated data.

    Attributes
    ----------
    failures : the choices it fails for, in the order surveyed
    """

    key: str
    holds: int
    total: int
    failures: tuple[StartData, ...]


def survey(
    mission: Mission, choices: Sequence[StartData], pairs: Sequence[tuple[AdaptiveScaling, AdaptiveScaling]],
    references: Sequence[PersistenceFilter],
) -> tuple[Survey, ...]:  # fmt: skip
    """Peaks and settling of every choice at once; the three statements that need no history.

    `pairs` (smaller and larger gamma) and `references` are the laws of each choice, in order.
    """
    starts = np.array([_state(choice) for choice in choices])
    slow, fast, reference = (
        simulate_ensemble(
            list(laws),
            mission.body,
            mission.schedule,
            starts,
            horizon=mission.horizon,
            metrics=MetricOptions.within(mission.tolerance),
        ).metrics
        for laws in ([p[0] for p in pairs], [p[1] for p in pairs], references)
    )
    assert slow is not None
    assert fast is not None
    assert reference is not None
    slow_settling, fast_settling = (
        np.where(np.isnan(m.settling_time), np.inf, m.settling_time) for m in (slow, fast)
    )
    held = {
        "lower_in_transient": slow.peak[LARGEST_COMPONENT] < reference.peak[LARGEST_COMPONENT],
        "gamma_peak": fast.peak[LARGEST_COMPONENT] > slow.peak[LARGEST_COMPONENT],
        "gamma_settling": fast_settling < slow_settling,
    }
    return tuple(
        Survey(
            key,
            int(np.count_nonzero(ok)),
            len(choices),
            tuple(choice for choice, good in zip(choices, ok, strict=True) if not good),
        )
        for key, ok in held.items()
    )


def _state(choice: StartData) -> np.ndarray:
    half = np.deg2rad(choice.angle_deg) / 2
    axis = np.ones(3) / np.sqrt(3)
    across = np.array([1.0, -1.0, 0.0]) / np.sqrt(2)
    return np.concatenate([[np.cos(half)], np.sin(half) * axis, choice.rate * across])
