"""What the printed update law does to a run: the gain falls, the attitude turns over, the filter dies."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ....models.laws import Law
from ....models.schedule import Hermite, Schedule, Window, build_schedule
from ....models.simulation import simulate
from .item import J1

F = Fraction
HORIZON = F(56)


def printed_schedule(*, overrun: bool = True) -> Schedule:
    """Period 8 s, on from 0.01 s to 3.21 s, g as printed (zero at 3.22 s) or ending with the window."""
    shape = Hermite(F("0.01") if overrun else F(0))
    return build_schedule([Window(F("0.01"), F("3.21"))], shape, period=F(8))


def printed_update_trajectory(law: Law) -> tuple[str, ...]:
    """Simulate from 120 deg about (1, 1, 1), at rest, k(0) = 0, R(0) = 1 s, and say what happens."""
    start = np.full(4, 0.5)
    run = simulate(law, J1, printed_schedule(), quaternion=start, rate=np.zeros(3), horizon=HORIZON)
    final = run.state(float(HORIZON))
    R, k = (float(run.controller_state(name, float(HORIZON))) for name in ("R", "k"))
    return (
        f"from (1/2, 1/2, 1/2, 1/2) at rest, J1, lambda = 0.525, gamma = 0.1, k(0) = 0, R(0) = 1: after "
        f"{float(HORIZON):g} s k = {k:.4g} 1/s, b0 = {float(final[0]):.6g}, R = {R:.3g} s",
    )
