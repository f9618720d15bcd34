"""Least peak torque through the windows: transcription, two solvers, verification, multi-start."""

from .check.any_torque import FlownTorque, fly_torque
from .check.verify_answer import FlownHistory, fly_again
from .search.minimum_impulse import LeastImpulseFound, minimum_impulse
from .search.minimum_peak import minimum_peak
from .search.minimum_time import LeastTime, minimum_time
from .search.options import MultiStart, Refinement
from .search.result import PeakAnswer, Search, Standing, Start, Switching
from .solvers.nlp import NonlinearProgram
from .solvers.scp import SequentialConvex
from .transcription.history import TorqueHistory

__all__ = [
    "FlownHistory",
    "FlownTorque",
    "LeastImpulseFound",
    "LeastTime",
    "MultiStart",
    "NonlinearProgram",
    "PeakAnswer",
    "Refinement",
    "Search",
    "SequentialConvex",
    "Standing",
    "Start",
    "Switching",
    "TorqueHistory",
    "fly_again",
    "fly_torque",
    "minimum_impulse",
    "minimum_peak",
    "minimum_time",
]
