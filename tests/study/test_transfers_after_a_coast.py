"""A moving start with a late first window: searched from the state there, bounded as it was stated."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.norms import NORMS
from intermit.scenario import ScenarioError, load_scenario
from intermit.study.optimum.coasting_start import after_coast
from intermit.study.optimum.run import idle_words, transfer
from scipy.integrate import solve_ivp

SCENARIO = """
[spacecraft]
inertia = {inertia}
[schedule]
windows = [[{lead}, {lead}.5], [{lead}1, {lead}2]]
[initial]
axis = [1, 2, 2]
angle_deg = 50
rate = {rate}
[optimum]
final_time = {lead}3
"""
BODY = "[[3, 0.1, 0], [0.1, 2, 0.2], [0, 0.2, 1]]"


def scenario(folder, lead="1000", rate="[0.02, -0.01, 0.03]", inertia=BODY):
    path = folder / "s.toml"
    text = SCENARIO.format(lead=lead, rate=rate, inertia=inertia)
    for k in (1, 2, 3):
        text = text.replace(f"{lead}{k}", str(int(lead) + k))
    path.write_text(text)
    return load_scenario(path)


def test_the_search_begins_where_the_coast_ends(tmp_path):
    found = scenario(tmp_path)
    stated = transfer(found, NORMS["euclidean"])
    problem, origin = after_coast(found, stated)
    assert (origin, problem.horizon, stated.horizon) == (1000, 3, 1003)
    assert [(p.start, p.end) for p in problem.open_pieces] == [(0, F(1, 2)), (1, 2)]
    J = found.body.inertia

    def motion(t, x):
        b, w = x[:4], x[4:]
        turn = np.concatenate([[-b[1:] @ w], b[0] * w + np.cross(b[1:], w)]) / 2
        return np.concatenate([turn, np.linalg.solve(J, -np.cross(w, J @ w))])

    start = np.concatenate([stated.unit_attitude, stated.start_rate])
    end = solve_ivp(motion, (0, 1000), start, method="DOP853", rtol=1e-12, atol=1e-13).y[:, -1]
    reached = [float(x) for x in (*problem.attitude, *problem.rate)]
    assert reached == pytest.approx(end, abs=1e-9)
    assert "turns freely until the first window" in idle_words(found, problem)


@pytest.mark.parametrize(("lead", "rate"), [("1000", "[0, 0, 0]"), ("1", "[0.02, -0.01, 0.03]")])
def test_rest_and_short_leads_are_left_as_they_are(tmp_path, lead, rate):
    found = scenario(tmp_path, lead, rate)
    stated = transfer(found, NORMS["euclidean"])
    assert after_coast(found, stated) == (stated, 0)


def test_too_many_turns_are_refused_with_their_number(tmp_path):
    with pytest.raises(ScenarioError, match=r"4\.77e\+4 turns"):
        scenario(tmp_path, "100000000", "[0.003, 0.002, 0.001]")
