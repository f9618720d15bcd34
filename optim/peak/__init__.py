"""Least peak torque through the windows: transcription, two solvers, verification, multi-start."""

from .any_torque import FlownTorque, fly_torque
from .history import TorqueHistory
from .minimum_impulse import LeastImpulseFound, minimum_impulse
from .minimum_peak import minimum_peak
from .minimum_time import LeastTime, minimum_time
from .nlp import NonlinearProgram
from .options import MultiStart, Refinement
from .result import PeakAnswer, Search, Standing, Start, Switching
from .scp import SequentialConvex
from .verify_answer import FlownHistory, fly_again

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
