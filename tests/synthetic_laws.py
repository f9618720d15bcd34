"""A law of the synthetic record: its run, claims and certificate (plausible numbers, labelled synthetic)."""

from __future__ import annotations

from typing import Any

import numpy as np
from intermit.models.laws import LAWS
from intermit.reports.parts import figure_of, quantity
from synthetic_runs import LAMBDA, Array, simulate


def claim(key: str, title: str, statement: str, verdict: str = "PROVED", **more: Any) -> dict[str, Any]:
    """A claim as the record holds it."""
    kind = {"PROVED": "theorem", "REFUTED": "witness", "UNDECIDED": "samples"}[verdict]
    base = {
        "key": key,
        "title": title,
        "statement": statement,
        "verdict": verdict,
        "quantities": [],
        "margins": [],
    }
    base |= {"evidence": [{"kind": kind, "summary": "synthetic evidence", "source": "Ram and Akella 2021"}]}
    return base | {"witness": None, "reason": "", "next_step": "", "source": "", "counted": True} | more


def case(name: str, label: str, adaptive: bool, gamma: float, arrays: dict[str, Array]) -> dict[str, Any]:
    """One law with its run, claims and certificate."""
    run = simulate(adaptive, gamma)
    arrays |= {f"{name}.{key}": value for key, value in run.items() if key != "Omega"}
    t = run["time"]
    floor = np.minimum.accumulate(run["R"]) * 0.97
    arrays |= {
        f"{name}.floor": floor,
        f"{name}.Vbound": run["V"][0] * np.exp(-0.02 * t) + 1.0 * adaptive * run["V"][0],
    }
    angle = 2 * np.arccos(np.clip(run["quaternion"][:, 0], -1, 1))
    arrays[f"{name}.angle_bound"] = np.minimum(
        2 * np.pi, np.maximum.accumulate(angle[::-1])[::-1] * 1.3 + 0.01
    )
    arrays[f"{name}.speed_bound"] = (
        0.01 + 1.3 * np.maximum.accumulate(np.linalg.norm(run["rate"], axis=1)[::-1])[::-1]
    )
    arrays[f"{name}.torque_bound"] = (
        0.01 + 5.0 * np.maximum.accumulate(np.linalg.norm(run["torque"], axis=1)[::-1])[::-1]
    )
    names = {
        "time": f"{name}.time",
        "quaternion": f"{name}.quaternion",
        "rate": f"{name}.rate",
        "gain": f"{name}.gain",
    }
    names |= {
        "command": f"{name}.command",
        "torque": f"{name}.torque",
        "storage": f"{name}.V",
        "storage_bound": f"{name}.Vbound",
    }
    controller = {"R": f"{name}.R"} | ({"k": f"{name}.k"} if adaptive else {})
    peak = np.abs(run["torque"]).max()
    norms = np.linalg.norm(run["torque"], axis=1)
    outside = (np.linalg.norm(run["quaternion"][:, 1:], axis=1) > 1e-2) | (
        np.linalg.norm(run["rate"], axis=1) > 1e-2
    )
    metrics = [
        figure_of(
            "peak_torque_component", peak, digits=7, unit="N m", label="Peak torque, largest component"
        ),
        figure_of("peak_torque_euclidean", norms.max(), digits=7, unit="N m", label="Peak torque, Euclidean"),
        figure_of(
            "impulse_euclidean", norms.sum() * (t[1] - t[0]), digits=4, unit="N m s", label="Angular impulse"
        ),
        figure_of("settling_time", t[outside].max(), digits=4, unit="s", label="Settling time"),
        figure_of("least_filter_state", run["R"].min(), digits=7, unit="s", label="Least R along the run"),
    ]
    floor_value = quantity(
        "filter_floor", floor.min(), unit="s", label="Certified floor of R", rigorous=True, side="lower"
    )
    claims = [
        claim(
            "filter.floor",
            "R stays positive",
            "R(t) >= R_min > 0 for every start in the set.",
            quantities=[floor_value],
            margins=[quantity("margin", floor.min(), floor.min() * 1.0001, unit="s", rigorous=True)],
            recheck="intermit recheck certificates/floor.json",
        ),
        claim(
            "convergence",
            "The attitude converges",
            "Error angle and rate tend to zero.",
            margins=[quantity("rate", 0.26, 0.27, unit="1/s", label="decay rate", rigorous=True)],
        ),
        claim(
            "lambda.paper",
            "Paper's condition on lambda",
            "lambda > max(1/(2 Jmin), 1/2)",
            counted=False,
            margins=[quantity("margin", 0.025, unit="1/s", rigorous=True)],
        ),
        claim(
            "storage.decrease",
            "V does not increase",
            "V' <= 0 on all states.",
            margins=[quantity("margin", 0.18411, 0.18412, unit="1/s", rigorous=True)],
        ),
        claim(
            "torque.limit",
            "Torque stays below the limit",
            "|g u| <= 5 N m for every start in the set.",
            verdict="UNDECIDED" if adaptive else "REFUTED",
            reason="the certified bound is 7.1 N m, the largest simulated torque 2.6 N m",
            next_step="narrow the initial set or raise the limit to 7.2 N m",
            witness=None
            if adaptive
            else {
                "description": "from rest at t = 8.4 s",
                "values": {"b": [0.5, 0.5, 0.5, 0.5], "t": 8.4},
                "violation": quantity("excess", 0.61, 0.62, unit="N m", rigorous=True),
            },
        ),
    ]
    certificate = {
        "key": "floor",
        "label": "R and error-angle bounds",
        "claim": "filter.floor",
        "quantities": [floor_value],
        "arrays": {
            "time": f"{name}.time",
            "filter_floor": f"{name}.floor",
            "angle_bound": f"{name}.angle_bound",
            "speed_bound": f"{name}.speed_bound",
            "torque_bound": f"{name}.torque_bound",
        },
        "recheck": "intermit recheck certificates/floor.json",
    }
    one = {
        "key": "run",
        "label": "120 deg about (1, 1, 1), from rest",
        "metrics": metrics,
        "arrays": names | {"controller": controller},
        "effort": [{"label": "right-hand sides", "count": 12345}],
    }
    parameters = [quantity("lambda", LAMBDA, unit="1/s", rigorous=True)] + (
        [quantity("gamma", gamma, rigorous=True)] if adaptive else []
    )
    law = "adaptive-scaling" if adaptive else "persistence-filter"
    return {
        "key": name,
        "label": label,
        "law": law,
        "equations": [{"title": e.title, "typst": e.typst, "latex": e.latex} for e in LAWS[law].equations],
        "parameters": parameters,
        "claims": claims,
        "runs": [one],
        "certificates": [certificate],
    }
