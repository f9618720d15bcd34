"""Schedule, optimum, samples, front, comparison and audit of the synthetic record: invented."""

from __future__ import annotations

from typing import Any

import numpy as np
from intermit.reports.parts import axis, column, figure, figure_of, quantity, series, table
from synthetic_laws import claim
from synthetic_runs import HORIZON, Array, gain


def schedule(arrays: dict[str, Array]) -> dict[str, Any]:
    """Schedule section."""
    t = np.linspace(0, HORIZON, 2801)
    arrays |= {"schedule.time": t, "schedule.gain": np.array([gain(s)[0] for s in t])}
    zero_run = quantity("zero_run", 4.79, unit="s", label="Longest zero run", rigorous=True)
    claims = [
        claim(
            "schedule.ordered",
            "Windows are ordered and disjoint",
            "7 windows in [0, 56] s.",
            quantities=[zero_run],
        ),
        claim("schedule.smooth", "g is C1", "Value and slope agree at all 28 knots."),
    ]
    return {
        "extends": "periodic",
        "windows": [[8 * k + 0.01, 8 * k + 3.21] for k in range(7)],
        "claims": claims,
        "arrays": {"time": "schedule.time", "gain": "schedule.gain"},
    }


def optimum(arrays: dict[str, Array], norm: str, value: float, low: float) -> dict[str, Any]:
    """Optimum section: an eigenaxis slew that speeds up in the first window and brakes in the last."""
    t = np.linspace(0, 51.22, 2049)
    push = np.where((t > 0.01) & (t < 3.21), 1.0, 0.0) - np.where((t > 48.01) & (t < 51.21), 1.0, 0.0)
    rate = np.cumsum(push) * (t[1] - t[0])
    turned = np.cumsum(rate) * (t[1] - t[0])
    half = np.radians(60) * (1 - turned / turned[-1])
    e = np.ones(3) / np.sqrt(3)
    p = f"optimum.{norm}"
    arrays |= {
        f"{p}.time": t,
        f"{p}.torque": -value * push[:, None] * np.ones(3),
        f"{p}.switching": np.cos(np.pi * t / 51.22),
        f"{p}.quaternion": np.column_stack([np.cos(half), np.sin(half)[:, None] * e]),
        f"{p}.rate": -rate[:, None] * e * 2 * np.radians(60) / turned[-1],
    }
    names = {key: f"{p}.{key}" for key in ("time", "torque", "switching", "quaternion", "rate")}
    label = {
        "component": "Least peak torque, largest component",
        "euclidean": "Least peak torque, Euclidean",
    }[norm]
    return {
        "key": norm,
        "label": label,
        "norm": norm,
        "profile": "full thrust inside the windows",
        "terminal": "at rest at the identity",
        "final_time": quantity("tf", 51.22, unit="s", rigorous=True),
        "value": figure_of("optimum", value, digits=7, unit="N m", label="Optimum found"),
        "bound": quantity(
            "bound", low, unit="N m", label="Certified lower bound", rigorous=True, side="lower"
        ),
        "bound_name": "invariant gauge",
        "gap": quantity("gap", 100 * (value - low) / value, unit="%", side="upper", label="Certified gap"),
        "arrays": names,
        "switch_times": [0.01, 3.21, 25.6, 48.01, 51.21],
        "residuals": [
            figure_of("terminal error", 3e-11, digits=2),
            figure_of("stationarity", 8e-10, digits=2),
        ],
        "local_optima": {"starts": 8, "values": [value, value, 1.17 * value], "unit": "N m"},
        "effort": [{"label": "cone programs", "count": 14}],
    }


def samples(arrays: dict[str, Array]) -> dict[str, Any]:
    """Derivative-bound samples."""
    rng = np.random.default_rng(7)
    margins = -np.abs(rng.normal(size=4000)) - 0.01
    arrays["samples.edges"] = np.linspace(-4, 0, 41)
    arrays["samples.counts"] = np.histogram(margins, arrays["samples.edges"])[0].astype(float)
    worst = {
        "description": "least margin",
        "values": {"b": [0.99, 0.1, 0.05, 0.05], "R": 0.2},
        "violation": quantity("V'", -0.0103, -0.0102, unit="1/s"),
    }
    return {
        "key": "decrease",
        "label": "V' along random states",
        "case": "adaptive",
        "count": 4000,
        "seed": 7,
        "coverage": "|Omega| <= 2, R in [0.1, 2]",
        "statement": "no violation in 4000 samples",
        "histogram": {"edges": "samples.edges", "counts": "samples.counts", "label": "V' / W", "unit": "1/s"},
        "worst": worst,
    }


def front(arrays: dict[str, Array]) -> dict[str, Any]:
    """Pareto front with its certified band."""
    t = np.array([11.22, 19.22, 27.22, 35.22, 51.22])
    arrays |= {
        "front.t": t,
        "front.low": 20.0 / t**2,
        "front.opt": 21.5 / t**2,
        "front.law": 60 / t,
        "front.law2": 140 / t,
    }
    lines = [
        series(
            "between certified bound and optimum",
            "front.t",
            "front.low",
            upper="front.opt",
            style="band",
            role="bound",
        ),
        series("optimum found", "front.t", "front.opt", style="line+points", role="optimum"),
        series("adaptive, best parameters", "front.t", "front.law", style="line+points", role="law"),
        series(
            "persistence filter, best parameters", "front.t", "front.law2", style="line+points", role="law"
        ),
    ]
    chart = figure(
        "front",
        "Peak torque against settling time",
        axis("settling time", "s"),
        axis("peak torque", "N m", log=True),
        lines,
        alt="Both laws need about a hundred times the optimum.",
    )
    return {"figures": [chart], "summary": "Every point is simulated again."}


def comparison() -> dict[str, Any]:
    """Law against optimum on equal terms."""
    columns = [
        column("law", "Law"),
        column("peak", "Peak", "N m"),
        column("settle", "Settling", "s"),
        column("optimum", "Optimum", "N m"),
        column("bound", "Certified bound", "N m"),
        column("ratio", "Law / optimum"),
        column("ok", "Order"),
    ]
    rows = [
        {
            "law": name,
            "peak": figure_of("p", peak, digits=6),
            "settle": figure_of("t", ts, digits=4),
            "optimum": figure_of("o", 0.0371, digits=5),
            "bound": quantity("b", 0.0352, side="lower", rigorous=True),
            "ratio": figure_of("r", peak / 0.0371, digits=3),
            "ok": {"verdict": "PROVED"},
        }
        for name, peak, ts in [("Adaptive scaling", 2.44, 26.72), ("Persistence filter", 5.5, 25.38)]
    ]
    return {
        "tables": [
            table(
                "comparison",
                "Each law against the optimum for its own settling time",
                columns,
                rows,
                notes=["Same windows, same terminal set."],
            )
        ]
    }


def audit() -> dict[str, Any]:
    """A few rows of errata."""
    columns = [
        column("id", "No."),
        column("printed", "Printed"),
        column("correct", "Corrected"),
        column("verdict", "Printed form"),
        column("shown", "How it shows"),
    ]
    rows = [
        {
            "id": "E1",
            "printed": {"code": "- 2 gamma g^2 R |bv|"},
            "correct": {"code": "+ 2 gamma g^2 R |bv|^2"},
            "verdict": {"verdict": "REFUTED"},
            "shown": "V' = +1.7e-4 at a state",
        },
        {
            "id": "E2",
            "printed": {"code": "J Omega' = -S(w) J w"},
            "correct": {"code": "J Omega' = -S(Omega) J w"},
            "verdict": {"verdict": "REFUTED"},
            "shown": None,
        },
    ]
    return {"tables": [table("errata", "The printed equations", columns, rows)]}
