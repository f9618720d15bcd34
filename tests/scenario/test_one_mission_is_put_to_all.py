"""A scenario's mission is what proofs, optima and runs are asked about: nothing of it is left out."""

from dataclasses import replace
from fractions import Fraction as F
from pathlib import Path
from typing import get_args

import intermit
import pytest
from intermit.models.mission import InitialSet, Tolerance
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, NORMS, NormWord
from intermit.optim.problem import Terminal, TransferProblem
from intermit.optim.tuning.conditions import certified_floor
from intermit.study.check.filter_question import floor_question, robust_question
from intermit.study.optimum.run import transfer
from intermit.study.options import NormKey
from intermit.study.simulated_run import RunFigures
from intermit.verify.filter.question import FloorQuestion
from missions import mission_from
from problems import J1, PERSISTENCE, paper_schedule

EXAMPLES = Path(intermit.__file__).parent / "examples"
WIDE = ((F("0.05"), F(0), F(0)), (F(0), F("0.05"), F(0)), (F(0), F(0), F("0.05")))


@pytest.fixture(scope="module")
def scenario(tmp_path_factory):
    file = tmp_path_factory.mktemp("mission") / "s.toml"
    text = (EXAMPLES / "paper.toml").read_text(encoding="utf-8")
    file.write_text(
        text.replace("[schedule]", "inertia_tolerance = 0.02\n\n[schedule]", 1)
        + '\n[limits]\ntorque = 3\nnorm = "euclidean"\n[uncertainty]\ndisturbance = 0.01\n',
        encoding="utf-8",
    )
    return intermit.load(file)


def test_it_holds_what_the_scenario_says(scenario):
    mission = scenario.mission
    assert mission.body == scenario.body
    assert mission.schedule == scenario.schedule
    assert mission.start == scenario.initial
    assert mission.starts == scenario.initial_set
    assert mission.horizon == scenario.horizon
    assert mission.tolerance == Tolerance(scenario.tolerance.attitude, scenario.tolerance.rate)
    assert (mission.limit.torque, mission.limit.norm) == (F(3), EUCLIDEAN)
    assert mission.inertia_tolerance == scenario.inertia_tolerance is not None
    assert mission.uncertainty.channels == ("disturbance",)


def test_every_question_is_about_it(scenario):
    law = scenario.laws[0].build()
    assert floor_question(scenario, law, RunFigures(), search=False).mission == scenario.mission
    assert robust_question(scenario, law).mission == scenario.mission
    assert floor_question(scenario, law, RunFigures(), search=False).bounds.least < float(
        FloorQuestion(law=law, mission=replace(scenario.mission, inertia_tolerance=None)).bounds.least
    )


def test_the_transfer_is_derived_from_it(scenario):
    mission = scenario.mission
    own = TransferProblem.of(mission, LARGEST_COMPONENT)
    assert own.terminal == Terminal(mission.tolerance.attitude, mission.tolerance.rate)
    assert own.horizon == mission.horizon
    assert own.attitude == mission.start.exact_quaternion
    asked = transfer(scenario, LARGEST_COMPONENT)
    assert asked.body == mission.body
    assert asked.terminal != own.terminal, "the optimum's own tolerances, exact rest, are not the law's"


def test_words_of_norms_are_the_norms():
    assert get_args(NormWord) == tuple(NORMS)
    # options are read by --help, which loads no numbers: their words stand by themselves
    assert get_args(NormKey) == (*NORMS, "thrusters")


def test_the_set_around_a_start_holds_it():
    start = mission_from(J1, paper_schedule(), (0.5, 0.5, 0.5, 0.5), (F(1, 10), F(1, 5), F(0))).start
    around = InitialSet.around(start)
    assert around.max_angle_deg >= F(start.angle_deg)
    assert around.max_rate**2 >= sum(x * x for x in start.exact_rate)
    assert around.max_rate**2 <= sum(x * x for x in start.exact_rate) * (1 + F(1, 10**12))


def test_a_sweeps_floor_heeds_the_inertias_tolerance():
    mission = mission_from(J1, paper_schedule(), (0.5, 0.5, 0.5, 0.5))
    exact = certified_floor(PERSISTENCE, mission)
    loose = certified_floor(PERSISTENCE, replace(mission, inertia_tolerance=WIDE))
    assert 0 < loose < exact
