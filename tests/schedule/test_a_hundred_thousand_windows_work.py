"""A schedule of 1e5 windows loads from a CSV file, and its facts and excitation are decided."""

import random
from fractions import Fraction

import pytest
from intermit.scenario import load_scenario
from intermit.verify.schedule.excitation import excitation_claim
from intermit.verify.schedule.facts import schedule_claims
from intermit.verify.verdict import Verdict

NUMBER = 100_000
TEXT = """
[spacecraft]
inertia = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]
[schedule]
csv = "windows.csv"
thruster_rise = 0.01
thruster_fall = 0.01
[initial]
quaternion = [1, 0, 0, 0]
"""


@pytest.mark.slow
def test_facts_of_many_windows(tmp_path):
    draw = random.Random(7)
    rows, t = ["on,off"], 0
    for _ in range(NUMBER):
        on = t + draw.randint(100, 900)
        t = on + draw.randint(50, 400)
        rows.append(f"{on / 100:.2f},{t / 100:.2f}")
    (tmp_path / "windows.csv").write_text("\n".join(rows))
    (tmp_path / "s.toml").write_text(TEXT)
    scenario = load_scenario(tmp_path / "s.toml")
    assert len(scenario.schedule.windows) == NUMBER
    assert scenario.horizon == scenario.schedule.windows[99].off
    assert all(c.verdict is Verdict.PROVED for c in schedule_claims(scenario.schedule))
    claim = excitation_claim(scenario.schedule)
    assert claim.verdict is Verdict.PROVED
    least = claim.quantities[0]
    start = Fraction(claim.quantities[0].label.split("t = ")[1].removesuffix(" s"))
    length = Fraction(claim.quantities[2].low).limit_denominator(100)
    # the stated instant is rounded to nine digits: the integral there is the minimum to about 1e-3 s
    assert least.low <= float(scenario.schedule.square_integral(start, start + length)) <= least.high + 1e-2
