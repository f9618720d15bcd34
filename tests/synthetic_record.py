"""A realistic record made without the package's own rooms: two laws simulated here, the rest invented."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from intermit.reports import Record
from intermit.reports.parts import quantity
from intermit.reports.provenance import provenance
from intermit.reports.record.base import parts_of
from intermit.reports.record.claims import QuantityEntry
from synthetic_laws import case
from synthetic_runs import HORIZON, J1, Array
from synthetic_studies import audit, comparison, front, optimum, samples, schedule

SCENARIO = """# Two laws through periodic windows
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]

[schedule]
period = 8.0
on = 0.01
on_time = 3.2

[initial]
axis = [1, 1, 1]
angle_deg = 120
"""


def thaw(value: Any) -> Any:
    """A fresh tree of dicts and lists from a record's read-only document."""
    if isinstance(value, Mapping):
        return {k: thaw(v) for k, v in value.items()}
    return [thaw(v) for v in value] if isinstance(value, tuple) else value


def quantities(record: Record) -> list[QuantityEntry]:
    """Every number with bounds in a record."""
    return [part for _, part in parts_of(record.sections, "record") if isinstance(part, QuantityEntry)]


def make(
    name: str = "paper-periodic", title: str = "Two laws through periodic windows", **changes: Any
) -> Record:
    """The synthetic record; `changes` replace whole sections (None drops one)."""
    arrays: dict[str, Array] = {}
    sections: dict[str, Any] = {
        "scenario": {
            "name": name,
            "description": "A micro-satellite turns 120 deg and stops.",
            "inertia": J1.tolist(),
            "horizon": HORIZON,
            "facts": [
                {"label": "Inertia", "matrix": J1.tolist(), "unit": "kg m^2"},
                {"label": "Start", "text": "120 deg about (1, 1, 1), at rest"},
                {"label": "Horizon", "quantity": quantity("horizon", HORIZON, unit="s", rigorous=True)},
            ],
            "tolerances": {"attitude": 0.01, "rate": 0.01},
        },
        "schedule": schedule(arrays),
        "cases": [
            case("adaptive", "Adaptive scaling, gamma = 0.1", True, 0.1, arrays),
            case("filter", "Persistence filter", False, 0.1, arrays),
        ],
        "samples": [samples(arrays)],
        "optimum": [
            optimum(arrays, "component", 0.0119761, 0.01072),
            optimum(arrays, "euclidean", 0.0189998, 0.01893),
        ],
        "comparison": comparison(),
        "front": front(arrays),
        "audit": audit(),
    }
    sections = {k: v for k, v in (sections | changes).items() if v is not None}
    origin = provenance(
        scenario_name=name,
        scenario_text=SCENARIO,
        date="2021-02-01",
        command=f"intermit report {name}.toml",
        author="A. Reviewer",
        seeds={"samples": 7, "starts": 3},
        options={"mesh": 24, "norms": ["component", "euclidean"]},
        effort=[{"label": "right-hand sides", "count": 24690}],
    )
    kept = {key: value for key, value in arrays.items() if f'"{key}"' in repr(sections).replace("'", '"')}
    outcome = {"exit_code": 1, "sentence": "The torque limit of 5 N m is refuted for the persistence filter."}
    return Record.create(title=title, provenance=origin, sections=sections, arrays=kept, outcome=outcome)
