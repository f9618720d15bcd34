"""E5, E6, E8, E9: the schedule table, the kinematics as printed, and where g reaches zero."""

from __future__ import annotations

from fractions import Fraction

import casadi as ca

from ....models.closed_loop import close_loop
from ....models.laws import QuaternionPD
from ....models.schedule import Schedule
from ....models.schedule import polynomial as poly
from ....verify.exact.rational_quantity import rational_quantity
from ....verify.filter.converged import ConvergedFilter
from ....verify.schedule.zero_runs import longest_zero_run
from ....verify.verdict import Witness
from .item import J1, AuditItem, exact_values, proved, refuted, tilted_state, undecided, vanishes
from .trajectory import printed_schedule

F = Fraction
PRINTED_ROWS = tuple(
    (F(on), F(off))
    for on, off in (
        ("0", "3.21"),
        ("8.01", "11.21"),
        ("16.01", "27.21"),
        ("32.01", "35.21"),
        ("40.01", "43.21"),
        ("48.01", "51.21"),
    )
)
"""Thruster on and off, s, as printed."""
RISE, ON_TIME, PERIOD = F("0.01"), F("3.2"), F(8)
"""t_r, t_on and T of the text, s."""
CORRECTED_ROWS = tuple((k * PERIOD + RISE, k * PERIOD + RISE + ON_TIME) for k in range(7))


def merged_rows() -> AuditItem:
    """E5: two windows printed as one row."""
    on, off = PRINTED_ROWS[2]
    witness = Witness(
        "third row of the table",
        {"on": float(on), "off": float(off)},
        rational_quantity("on-time - t_on", off - on - ON_TIME, unit="s"),
    )
    kept = (PRINTED_ROWS[1], *PRINTED_ROWS[3:])
    fits = all(row in CORRECTED_ROWS for row in kept) and len(CORRECTED_ROWS) == 7
    statement = "windows [8k + 0.01, 8k + 3.21] s, k = 0 to 6, satisfy T = 8 s and t_on = 3.2 s"
    return AuditItem(
        "E5",
        "thruster schedule, third row",
        "16.01 | 27.21",
        "16.01 | 19.21 and 24.01 | 27.21",
        refuted("E5", "every row of the table has t_on = 3.2 s", witness),
        proved("E5", statement, "exact comparison; the other rows are among them")
        if fits
        else undecided("E5", statement, "a printed row is not among them"),
        ("taken literally the thruster burns for 11.2 s on end, over two periods",),
    )


def first_row() -> AuditItem:
    """E6: the first on-time."""
    on, _ = PRINTED_ROWS[0]
    witness = Witness(
        "first row of the table",
        {"on": float(on)},
        rational_quantity("(0 T + t_r) - on", RISE - on, unit="s"),
    )
    statement = "on-times are k T + t_r, k = 0 to 6"
    fits = all(row[0] == k * PERIOD + RISE for k, row in enumerate(CORRECTED_ROWS))
    return AuditItem(
        "E6",
        "thruster schedule, first row",
        "0 | 3.21",
        "0.01 | 3.21",
        refuted("E6", "every on-time is k T + t_r", witness),
        proved("E6", statement, "exact comparison") if fits else undecided("E6", statement, "it is not"),
        ("the text sets g(t_r) = 0, so a window that opens at 0 would have its thruster idle for t_r",),
    )


def kinematics() -> AuditItem:
    """E8: the vector in the first row of the kinematics."""
    loop = close_loop(QuaternionPD(F(1), F(1)))
    b0, bv, w = loop.plant.b0, loop.plant.bv, loop.plant.w
    other = ca.SX.sym("beta_t", 3)
    norm_rate = 2 * b0 * (-ca.dot(other, w) / 2) + 2 * ca.dot(bv, loop.plant.bv_rate)
    state = tilted_state()
    extra = {f"beta_t{i + 1}": (other[i], F(i)) for i in range(3)}
    (violation,) = exact_values(loop, norm_rate, state, J1, extra)
    witness = Witness(
        "beta_t = (0, 1, 2), any vector but bv: |beta|^2 does not stay 1",
        state.floats(),
        rational_quantity("d|beta|^2/dt", violation, unit="1/s"),
    )
    # b0' = -bt.w/2 changes |beta|^2 at the rate b0 (bv - bt).w: zero for every state only if bt = bv
    only_bv = vanishes(loop, norm_rate - b0 * ca.dot(bv - other, w), {f"bt{i}": other[i] for i in range(3)})
    keeps = vanishes(loop, ca.substitute(norm_rate, other, bv))
    statement = "d|beta|^2/dt = b0 (bv - beta_t).w, which vanishes identically only for beta_t = bv"
    return AuditItem(
        "E8",
        "quaternion kinematics",
        "b0' = -(1/2) beta_t.w, with beta_t undefined",
        "b0' = -(1/2) bv.w",
        refuted("E8", "beta_t may be another vector", witness),
        proved("E8", statement, "exact polynomial identity")
        if only_bv and keeps
        else undecided("E8", statement, "the identity fails"),
    )


def overrun() -> AuditItem:
    """E9: where g reaches zero."""
    printed, corrected = printed_schedule(), printed_schedule(overrun=False)
    instant = F("3.215")
    value = gain_at(printed, instant)
    witness = Witness(
        "t = 3.215 s: the thruster shut off at 3.21 s and is falling",
        {"t": float(instant)},
        rational_quantity("g", value),
    )
    inside = gain_at(corrected, F("3.21")) == 0 and gain_at(corrected, instant) == 0
    statement = "with g(t_r + t_on) = 0 the gain vanishes outside [0.01, 3.21] s"
    figures = []
    for name, schedule in (("as printed", printed), ("corrected", corrected)):
        floor = ConvergedFilter(schedule, F("0.525")).floor()
        run = longest_zero_run(schedule)
        assert run is not None
        figures += [
            rational_quantity(f"zero run, {name}", run.length, unit="s"),
            rational_quantity(f"converged R_min, {name}", F(floor.low), F(floor.high), "s"),
        ]
    return AuditItem(
        "E9",
        "definition of g",
        "g(2 t_r + t_on) = 0, at 3.22 s",
        "g(t_r + t_on) = 0, at 3.21 s (probably)",
        refuted("E9", "g is zero while the thruster falls", witness),
        proved("E9", statement, "exact evaluation of the piecewise polynomial")
        if inside
        else undecided("E9", statement, "g is not zero there"),
        figures=tuple(figures),
    )


def gain_at(schedule: Schedule, t: Fraction) -> Fraction:
    """g(t) exactly, for t inside the first period."""
    for piece in schedule.profile.pieces:
        if piece.start <= t <= piece.end:
            return poly.evaluate(piece.shape, (t - piece.start) / piece.length)
    return F(0)
