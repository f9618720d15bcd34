"""A least peak called CHECKED is that within its mesh gap, however the windows are cut or placed."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.peak import MultiStart, Refinement, Standing, minimum_peak
from intermit.optim.peak.search.resolution import SHORTEST, open_time, resolved
from intermit.optim.problem import Terminal, TransferProblem, quaternion_from_axis_angle
from problems import J1, UNIT

ONE = MultiStart(starts=1)


def through(windows, horizon, *, norm=None, body=J1, angle=50.0, terminal=None):
    """Transfer of `angle` deg about (1, 1, 1) from rest through exact windows; gaps may be of any size."""
    knots, shapes = [Fraction(0)], []
    for on, off in windows:
        if Fraction(on) > knots[-1]:
            knots.append(Fraction(on))
            shapes.append(())
        knots.append(Fraction(off))
        shapes.append((Fraction(1),))
    if knots[-1] < horizon:
        knots.append(Fraction(horizon))
        shapes.append(())
    return TransferProblem(
        body=body,
        window=PiecewisePolynomial(tuple(knots), tuple(shapes)),
        attitude=quaternion_from_axis_angle([1, 1, 1], math.radians(angle)),
        norm=norm or EUCLIDEAN,
        terminal=terminal or Terminal(),
    )


@pytest.mark.parametrize("gap", ["1e-30", "1e-17", "6e-17", "1e-15", "1e-13", "1e-10"])
@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT])
def test_a_gap_of_no_length_changes_nothing(gap, norm):
    """Open time lost is under 1e-10 s of 8 s: the peak is that of touching windows within both mesh gaps."""
    rough = Refinement(mesh_gap=1e-5)
    split = Fraction(7, 10)
    whole = minimum_peak(through([(0, 3), (7, 9), (13, 16)], 16, norm=norm), search=ONE, refinement=rough)
    cut = through([(0, split), (split + Fraction(gap), 3), (7, 9), (13, 16)], 16, norm=norm)
    answer = minimum_peak(cut, search=ONE, refinement=rough)
    assert whole.standing is Standing.CHECKED, whole.reason
    assert answer.standing is Standing.CHECKED, answer.reason
    assert abs(answer.peak / whole.peak - 1) <= whole.mesh_gap + answer.mesh_gap + 2e-8
    assert answer.flown.outside_torque == 0.0


def test_a_window_of_no_length_changes_nothing():
    rough = Refinement(mesh_gap=1e-5)
    plain = minimum_peak(through([(0, 3), (7, 9)], 9), search=ONE, refinement=rough)
    speck = minimum_peak(
        through([(0, 3), (5, 5 + Fraction("1e-16")), (7, 9)], 9), search=ONE, refinement=rough
    )
    assert speck.standing is Standing.CHECKED, speck.reason
    assert abs(speck.peak / plain.peak - 1) <= plain.mesh_gap + speck.mesh_gap + 2e-8


@pytest.mark.parametrize("length", [Fraction(1, 1000), Fraction(1, 10)])
def test_windows_below_precision_are_not_checked(length):
    """Two short windows, 1e9 s apart: their lengths in double precision are a few digits."""
    windows = [(0, length), (10**9, 10**9 + length)]
    answer = minimum_peak(through(windows, 10**9 + 1, body=UNIT), search=ONE)
    assert answer.standing is Standing.UNDECIDED
    assert "double precision" in answer.reason


def test_a_resolved_window_lies_inside_the_true_one():
    horizon = Fraction(10)
    speck = horizon * SHORTEST / 3
    windows = [(0, 1), (1 + speck, 2), (3, 3 + speck), (4, 5), (5 + speck, 5 + 2 * speck), (6, 10)]
    problem = through(windows, horizon)
    small = resolved(problem)
    lost = open_time(problem.window) - open_time(small.window)
    assert 0 < lost < 8 * horizon * SHORTEST
    assert min(np.diff(small.window.knots)) >= horizon * SHORTEST / 4
    true = [(piece.start, piece.end) for piece in problem.open_pieces]
    for piece in small.open_pieces:
        assert any(on <= piece.start and piece.end <= off for on, off in true)
    whole = through([(0, 1), (4, 5)], horizon)
    assert resolved(whole) is whole


def test_what_is_not_a_number_meets_no_standard():
    """A gap or a miss that could not be computed is never below its limit."""
    answer = minimum_peak(through([(0, 3), (7, 9)], 9), search=ONE, refinement=Refinement(mesh_gap=1e-3))
    assert answer.flown.feasible
    unknown = replace(answer.flown, effort_excess=math.nan)
    assert not unknown.feasible
    assert unknown.faults


def test_the_end_is_measured_against_the_way():
    """A transfer of 1e-9 rad is not made by doing nothing: its standard is a millionth of its way."""
    answer = minimum_peak(
        through([(0, 3), (7, 9)], 9, angle=math.degrees(1e-5)),
        search=ONE,
        refinement=Refinement(mesh_gap=1e-4),
    )
    assert answer.flown.standard <= 1.0001e-11
    whole = minimum_peak(
        through([(0, 3), (7, 9)], 9, angle=5.0), search=ONE, refinement=Refinement(mesh_gap=1e-4)
    )
    assert whole.standing is Standing.CHECKED
    assert whole.flown.standard == 1e-8
    if answer.standing is Standing.CHECKED:
        small = math.radians(5.0) / 1e-5
        assert answer.peak * small == pytest.approx(whole.peak, rel=2e-3)
