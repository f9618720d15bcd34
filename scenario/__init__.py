"""The file a user writes: read, checked and built into objects of `models`."""

from ..models.mission import InitialSet, InitialState
from .errors import ScenarioError
from .extra_law import law_from_words, with_laws
from .laws import LawChoice
from .scenario import Scenario, load_scenario
from .schedules import ScheduleChoice
from .template import TEMPLATE, example_files, write_examples, write_template

__all__ = [
    "TEMPLATE",
    "InitialSet",
    "InitialState",
    "LawChoice",
    "Scenario",
    "ScenarioError",
    "ScheduleChoice",
    "example_files",
    "law_from_words",
    "load_scenario",
    "with_laws",
    "write_examples",
    "write_template",
]
