"""Transfers from a moving start whose first window is late: the free motion until then, integrated once."""

from __future__ import annotations

from fractions import Fraction

from ...models.laws.free_motion import FreeMotion
from ...models.simulation import SimulationError, simulate
from ...optim.problem import TransferProblem
from ...scenario import Scenario, ScenarioError


def after_coast(scenario: Scenario, problem: TransferProblem) -> tuple[TransferProblem, Fraction]:
    """State a transfer from its first window on, and the instant from which its time counts, s.

    No torque acts before, whatever the controller: the state at the first window is the start's own, known
    to the simulation's tolerance. A search from there costs nothing for the turns before it; bounds, which
    are proofs about the start as it was given, are not taken from it.

    Raises
    ------
    ScenarioError
        If the body turns more often until then than can be followed, with the number of turns.
    """
    if problem.starts_at_rest or not problem.open_pieces:
        return problem, Fraction(0)
    first, last = problem.open_pieces[0].start, problem.open_pieces[-1].end
    if first <= last - first:
        return problem, Fraction(0)
    try:
        run = simulate(
            FreeMotion(),
            problem.body,
            scenario.schedule,
            quaternion=problem.unit_attitude,
            rate=problem.start_rate,
            horizon=first,
        )
    except SimulationError as error:
        raise ScenarioError(f"{scenario.path.name}: optimum.final_time", str(error)) from None
    state = [Fraction(x) for x in run.segments[-1].end_state.tolist()]
    attitude = state[0], state[1], state[2], state[3]
    return problem.from_instant(first, attitude, (state[4], state[5], state[6])), first
