"""Costs that must not creep up, counted rather than timed: operations, evaluations, modules loaded."""

import subprocess
import sys
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.ensemble import simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.lowering import ArrayFunction, shared, walk
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify.schedule.excitation import excitation

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
PAPER = build_schedule(
    [Window(Fraction("0.01"), Fraction("3.21"))], Hermite(Fraction("0.01")), period=Fraction(8)
)
ADAPTIVE = AdaptiveScaling(Fraction("0.525"), Fraction("0.1"), Fraction(1), Fraction("0.2"))
PERSISTENCE = PersistenceFilter(Fraction("0.525"), Fraction(1))


def modules_after(code):
    """Modules a fresh interpreter has loaded once it has run the code."""
    report = "import sys; print('\\n'.join(sorted({n.split('.')[0] for n in sys.modules})))"
    run = subprocess.run(
        [sys.executable, "-c", f"{code}\n{report}"], capture_output=True, text=True, check=True
    )
    return set(run.stdout.split())


def test_importing_the_package_loads_nothing_heavy():
    heavy = {"numpy", "scipy", "casadi", "cvxpy", "clarabel", "matplotlib", "flint", "pydantic", "heyoka"}
    assert not modules_after("import intermit") & heavy
    assert "numpy" in modules_after("import intermit.models.ensemble")  # the probe sees what is there


def test_simulating_loads_no_solver_plotting_or_backend():
    loaded = modules_after(
        "import intermit.models.ensemble, intermit.models.lowering, intermit.models.linear"
    )
    assert not loaded & {"cvxpy", "clarabel", "matplotlib", "flint", "heyoka", "pydantic"}


@pytest.mark.parametrize(("law", "most"), [(ADAPTIVE, 200), (PERSISTENCE, 180)], ids=lambda x: str(x)[:12])
def test_a_right_hand_side_takes_few_operations(law, most):
    loop = close_loop(law)
    arrays = ArrayFunction(shared(walk(loop.function("rates", loop.state_rate))), uniform=(2, 3))
    assert arrays.sample_operations <= most


def test_runs_take_few_right_hand_sides():
    rng = np.random.default_rng(3)
    q = rng.normal(size=(6, 4))
    q[:, 0] = np.abs(q[:, 0])
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    starts = np.hstack([q, rng.uniform(-0.2, 0.2, (6, 3))])
    result = simulate_ensemble(ADAPTIVE, J1, PAPER, starts, horizon=Fraction(16))
    assert result.evaluations.max() <= 2500


def test_the_cost_of_a_run_is_that_of_its_horizon():
    start = [0.5, 0.5, 0.5, 0.5, 0.02, 0, 0]
    short, long = (
        simulate_ensemble(PERSISTENCE, J1, PAPER, start, horizon=Fraction(h)).evaluations[0] for h in (16, 64)
    )
    assert long <= 4.2 * short


def jittered(count):
    rng = np.random.default_rng(0)
    at, windows = Fraction(0), []
    for gap in rng.integers(400, 600, count):
        at += Fraction(int(gap), 100)
        windows.append(Window(at, at + Fraction(16, 5)))
        at += Fraction(16, 5)
    return build_schedule(windows, Hermite())


def test_excitation_decides_few_tied_pieces_in_rationals():
    """Unequal gaps make many intervals that hold the same whole windows: ties, each counted once."""
    result = excitation(jittered(600), Fraction(20))
    assert result.segments > 4000
    assert result.exact_segments < 100
