"""The file a user writes: read, checked and built into objects of `models`."""

from .errors import ScenarioError
from .initial import InitialSet, InitialState
from .laws import LawChoice
from .scenario import Scenario, load_scenario
from .schedules import ScheduleChoice

__all__ = [
    "InitialSet",
    "InitialState",
    "LawChoice",
    "Scenario",
    "ScenarioError",
    "ScheduleChoice",
    "load_scenario",
]
