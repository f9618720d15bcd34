"""Simulation of one run, never across a schedule knot, and the figures read off it."""

from .figures import Figures, read_figures
from .integrate import DOP853, simulate
from .metrics import (
    Extremum,
    Invariants,
    TorqueMetrics,
    filter_minimum,
    invariants,
    maximum,
    minimum,
    peak_commanded_torque,
    peak_torque,
    settling_time,
    torque_metrics,
)
from .missions import read_mission_figures, simulate_mission
from .phases import Phase, phase_field, phases_between, signal_degree
from .right_hand_side import SimulationError
from .trajectory import Segment, Signals, Trajectory

__all__ = [
    "DOP853",
    "Extremum",
    "Figures",
    "Invariants",
    "Phase",
    "Segment",
    "Signals",
    "SimulationError",
    "TorqueMetrics",
    "Trajectory",
    "filter_minimum",
    "invariants",
    "maximum",
    "minimum",
    "peak_commanded_torque",
    "peak_torque",
    "phase_field",
    "phases_between",
    "read_figures",
    "read_mission_figures",
    "settling_time",
    "signal_degree",
    "simulate",
    "simulate_mission",
    "torque_metrics",
]
