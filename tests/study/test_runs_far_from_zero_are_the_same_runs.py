"""The origin of time is no physics: firings moved by years give the same figures at the same cost."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.schedule.variants import starting_at
from intermit.scenario import load_scenario
from intermit.study.simulated_run import metrics, run_law

SCENARIO = """
[spacecraft]
inertia = [[1, 0, 0], [0, 2, 0], [0, 0, 3]]
[schedule]
windows = [{windows}]
[initial]
axis = [0, 0, 1]
angle_deg = 30
{rate}
[[law]]
type = "quaternion-pd"
proportional = 1
derivative = 2.5
[simulation]
horizon = {horizon}
output_step = {step}
"""


def random_firings(seed):
    rng = np.random.default_rng(seed)
    at, windows = F(1), []
    for _ in range(rng.integers(2, 6)):
        length = F(int(rng.integers(10, 500)), 1000)
        windows.append((at, at + length))
        at += length + F(int(rng.integers(5, 300)), 100)
    return windows


def run(folder, windows, shift, rate=""):
    text = ", ".join(f"[{float(a + shift):.3f}, {float(b + shift):.3f}]" for a, b in windows)
    end = windows[-1][1] + 2 + shift
    path = folder / f"moved-{shift}.toml"
    path.write_text(SCENARIO.format(windows=text, horizon=float(end), step=max(1, shift // 100), rate=rate))
    scenario = load_scenario(path)
    return scenario, run_law(scenario, scenario.laws[0].build())


@pytest.mark.parametrize("seed", range(6))
def test_moved_tables_give_the_same_figures(tmp_path, seed):
    windows = random_firings(seed)
    _, still = run(tmp_path, windows, 0)
    for shift in (10**3, 10**6, 1_760_000_000):
        _, moved = run(tmp_path, windows, shift)
        assert moved.origin == windows[0][0] + shift
        known = {m.name: m for m in metrics(still)}
        for metric in metrics(moved):
            low, same = metric.low, known[metric.name].low
            if same is None:
                assert low is None, metric.name
                continue
            assert low == pytest.approx(same, rel=1e-9, abs=1e-12), metric.name
        assert moved.trajectory.evaluations <= 1.2 * still.trajectory.evaluations


def test_time_counted_from_an_instant_is_the_same_schedule(tmp_path):
    windows = random_firings(7)
    scenario, _ = run(tmp_path, windows, 10**6)
    plain, _ = run(tmp_path, [(a - 1, b - 1) for a, b in windows], 0)
    assert starting_at(scenario.schedule, F(10**6 + 1)) == plain.schedule
    with pytest.raises(ValueError, match="g acts"):
        starting_at(scenario.schedule, scenario.schedule.windows[0].on + F(1, 1000))


def test_a_tumbling_start_leaves_nothing_out(tmp_path):
    _, found = run(tmp_path, random_firings(1), 10**3, rate="rate = [0, 0, 0.01]")
    assert found.origin == 0
