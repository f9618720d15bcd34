"""Least peak torque through the windows: transcription, two solvers, verification, multi-start."""

from .check.any_torque import ReplayedTorque, replay_torque
from .check.verify_answer import ReplayedHistory, replay
from .search.minimum_impulse import LeastImpulseFound, minimum_impulse
from .search.minimum_peak import minimum_peak
from .search.minimum_time import LeastTime, minimum_time
from .search.options import MultiStart, Refinement
from .search.result import PeakAnswer, Search, Standing, Start, Switching
from .solvers.nlp import NonlinearProgram
from .solvers.scp import SequentialConvex
from .transcription.history import TorqueHistory

__all__ = [
    "LeastImpulseFound",
    "LeastTime",
    "MultiStart",
    "NonlinearProgram",
    "PeakAnswer",
    "Refinement",
    "ReplayedHistory",
    "ReplayedTorque",
    "Search",
    "SequentialConvex",
    "Standing",
    "Start",
    "Switching",
    "TorqueHistory",
    "minimum_impulse",
    "minimum_peak",
    "minimum_time",
    "replay",
    "replay_torque",
]
