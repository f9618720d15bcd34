"""Units in the headers of CSV files: a column's name, and the exact factor to the unit used inside."""

from __future__ import annotations

import re
from dataclasses import dataclass
from fractions import Fraction
from typing import final

TIME = {
    "s": Fraction(1), "sec": Fraction(1), "secs": Fraction(1), "second": Fraction(1), "seconds": Fraction(1),
    "ms": Fraction(1, 1000), "msec": Fraction(1, 1000), "millisecond": Fraction(1, 1000),
    "milliseconds": Fraction(1, 1000),
    "us": Fraction(1, 10**6), "usec": Fraction(1, 10**6), "µs": Fraction(1, 10**6), "μs": Fraction(1, 10**6),
    "microseconds": Fraction(1, 10**6), "ns": Fraction(1, 10**9),
    "min": Fraction(60), "mins": Fraction(60), "minute": Fraction(60), "minutes": Fraction(60),
    "h": Fraction(3600), "hr": Fraction(3600), "hrs": Fraction(3600), "hour": Fraction(3600),
    "hours": Fraction(3600), "d": Fraction(86400), "day": Fraction(86400), "days": Fraction(86400),
}  # fmt: skip
"""Seconds in each unit of time."""

THRUST = dict.fromkeys(
    [
        *(f"{p}{unit}" for p in ("", "k", "m", "u", "µ", "μ") for unit in ("N", "Nm", "N m", "N*m", "N.m")),
        "%",
        "-",
    ],
    Fraction(1),
)
"""Units that thrust may be given in: only its ratio to full thrust, in the same unit, counts."""

OF_KEYS = (
    dict.fromkeys(("angle_deg", "max_angle_deg"), "deg")
    | dict.fromkeys(("rate", "max_rate", "rate_tolerance"), "rad/s")
    | dict.fromkeys(
        (
            "period", "on", "on_time", "ramp_up", "ramp_down", "thruster_rise", "thruster_fall", "time",
            "horizon", "output_step", "final_time", "settle", "pe_window", "R0",
        ),
        "s",
    )
    | dict.fromkeys(("torque", "torque_limit"), "N m")
    | dict.fromkeys(("inertia", "inertia_moments", "inertia_tolerance"), "kg m^2")
    | {"lambda": "1/s", "k0": "1/s"}
)  # fmt: skip
"""The unit of a scenario's keys, for messages about keys and values that name another."""
_SUFFIX = re.compile(
    r"_(deg|rad|degrees|radians|rad_?p?_?s|deg_?p?_?s|rpm|ms|us|s|sec|seconds|min|h|nm|mnm|n_?m|kgm2|kg_m2)$",
    re.IGNORECASE,
)


def bare_key(key: str) -> str:
    """A key without the unit that it names: "rate_deg_s" is "rate"."""
    return _SUFFIX.sub("", key)


SPOKEN = "ns, us, ms, s, min, h, d"
"""The units of time as messages name them."""
SUBJECTS = frozenset({"window", "burn", "firing", "fire", "valve", "thruster", "pulse", "jet"})
"""Words of a column's name that say whose instants it holds."""
INSTANTS = frozenset({"time", "t", "at", "instant", "timestamp", "date", "datetime", "utc"})
"""Words of a column's name that say that it holds instants."""

_TAIL = re.compile(r"(?<=[a-z])[A-Z][a-z]*$")
_BRACKETED = re.compile(r"(?P<name>[^\[\](){}/]*?)\s*[\[({/]\s*(?P<unit>[^\[\](){}]*?)\s*[\])}]?")


@final
@dataclass(frozen=True)
class Heading:
    """A column's name without its unit, lower case, words joined by "_"; and the unit as written, or None."""

    name: str
    unit: str | None


def heading(text: str, units: frozenset[str]) -> Heading:
    """Split "on [ms]", "on (in ms)", "on/ms", "on_ms", "on.ms", "onMs", "on ms" into name and unit.

    Parameters
    ----------
    text : str
        The cell of the header.
    units : frozenset[str]
        The units that may follow a name without brackets; in brackets any word is a unit.
    """
    cell = text.strip()
    found = _BRACKETED.fullmatch(cell)
    if found and found["name"]:
        return Heading(_plain(found["name"]), re.sub(r"^in\s+", "", found["unit"]))
    words = re.split(r"[\s_\-.]+", cell)
    for count in (2, 1):
        unit = " ".join(words[-count:])
        if len(words) > count and unit in units:
            return Heading(_plain(" ".join(words[:-count])), unit)
    tail = _TAIL.search(cell)
    if tail and (unit := tail[0].lower()) in units:
        return Heading(_plain(cell[: tail.start()]), unit)
    return Heading(_plain(cell), None)


def core(name: str) -> str:
    """What a column's name says beside its subject and that it is an instant: "valve_open_time" is "open".

    Of "on_time" and "off_time" the time stays: it may be a duration.
    """
    words = name.split("_")
    kept = [word for word in words if word not in SUBJECTS | INSTANTS]
    if kept in (["on"], ["off"]) and "time" in words:
        return f"{kept[0]}_time"
    return "_".join(kept) or name


def _plain(name: str) -> str:
    apart = re.sub(r"(?<=[a-z])(?=[A-Z])", " ", name.strip())
    return re.sub(r"[\s_\-.]+", "_", apart.lower()).strip("_")
