"""The storage function along a run, beside what is proved of it."""

from __future__ import annotations

from fractions import Fraction

import casadi as ca
import numpy as np

from ...models.closed_loop import body_values
from ...models.simulation import Trajectory
from ...models.storage import weighted_storage
from ...models.types import Array
from ...verify.verdict import Claim, Verdict


def storage_history(
    trajectory: Trajectory, times: Array, floor: Fraction | None, claim: Claim | None
) -> dict[str, Array]:
    """V and V' at the given times, and their certified upper bounds where V' <= -rho W is proved.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    times : Array
        Instants, (n,), s.
    floor : Fraction, optional
        R_min in k* = 1/R_min, s.
    claim : Claim, optional
        The run's law's "lyapunov.derivative".

    Returns
    -------
    dict
        storage, storage_rate (kg m^2/s, kg m^2/s^2), and if proved storage_rate_bound = -rho W and
        storage_bound: V(0) exp(-rho t) where V = W, else V(0). Empty for a law outside the family.
    """
    loop = trajectory.loop
    try:
        storage = weighted_storage(loop)
    except ValueError:
        return {}
    if floor is None or trajectory.is_saturated_model:
        return {}
    symbols, values = [storage.weight], [float(loop.law.parameters.get("a", Fraction(1)))]
    if storage.gain_target is not None:
        symbols, values = [*symbols, storage.gain_target], [*values, float(1 / floor)]
    expressions = ca.substitute([storage.value, storage.derivative, storage.reference], symbols, values)
    evaluate = loop.function("storage", *expressions)
    parameters = np.tile(loop.parameter_values()[:, None], times.size)
    body = np.tile(body_values(trajectory.body)[:, None], times.size)
    found = evaluate(np.atleast_2d(trajectory.state(times)), trajectory.time_signals(times), parameters, body)
    V, rate, W = (np.asarray(x, dtype=float).ravel() for x in found)
    history = {"storage": V, "storage_rate": rate}
    rho = _certified_rate(claim)
    if rho is None:
        return history
    decays = storage.gain_target is None
    bound = V[0] * np.exp(-rho * (times - times[0])) if decays else np.full(times.size, V[0])
    return history | {"storage_bound": bound, "storage_rate_bound": -rho * W}


def _certified_rate(claim: Claim | None) -> float | None:
    """The rate rho of V' <= -rho W, 1/s, if it is proved."""
    if claim is None or claim.verdict is not Verdict.PROVED:
        return None
    return next((q.low for q in claim.quantities if q.name == "certified_rate"), 0.0)
