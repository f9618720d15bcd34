"""Where a record comes from: versions, seeds, options, input and date. No clock is read."""

from __future__ import annotations

import hashlib
import os
import platform
from collections.abc import Mapping, Sequence
from datetime import UTC, datetime
from importlib.metadata import PackageNotFoundError, version

from .record.document import Provenance
from .record.runs import EffortEntry
from .record.values import plain

PACKAGES = ("casadi", "clarabel", "cvxpy", "numpy", "python-flint", "scipy", "heyoka")
"""Packages whose version can change a number."""


def provenance(
    *,
    scenario_name: str,
    scenario_text: str,
    date: str = "",
    command: str = "",
    author: str = "",
    seeds: Mapping[str, int] | None = None,
    options: Mapping[str, object] | None = None,
    effort: Sequence[EffortEntry] = (),
    inputs: Sequence[bytes] = (),
) -> Provenance:
    """Collect the provenance part of a record.

    Parameters
    ----------
    scenario_name, scenario_text : str
        The scenario's name and its file, verbatim.
    date : str
        Date the user gave; if empty, SOURCE_DATE_EPOCH as an ISO date; else the record is undated.
    command, author : str
        What was asked, in the words of the command line, and by whom (for the title block).
    seeds, options
        Every seed and option that decides a number.
    effort
        Counted work: evaluations, iterations, boxes. Never time.
    inputs : sequence of bytes
        Contents of the other files the scenario names, in order; they enter the hash.

    Returns
    -------
    Provenance
        `input_sha256` is the hash of the scenario's text and those files, each preceded by its length.
    """
    return Provenance(
        package_version=package_version("intermit"),
        command=command,
        author=author,
        scenario_name=scenario_name,
        scenario_text=scenario_text,
        input_sha256=input_hash(scenario_text, inputs),
        date=date or source_date(),
        versions={"python": platform.python_version()}
        | {p: v for p in PACKAGES if (v := package_version(p))},
        seeds=dict(seeds or {}),
        options=plain(options or {}),
        effort=tuple(effort),
    )


def input_hash(scenario_text: str, inputs: Sequence[bytes] = ()) -> str:
    """Hash the scenario's text and the files it names, lengths included."""
    digest = hashlib.sha256()
    for part in (scenario_text.encode("utf-8", "surrogatepass"), *inputs):
        digest.update(len(part).to_bytes(8, "big") + part)
    return digest.hexdigest()


def source_date() -> str:
    """SOURCE_DATE_EPOCH as an ISO date (UTC), or "" if it is not set."""
    epoch = os.environ.get("SOURCE_DATE_EPOCH", "")
    if not epoch:
        return ""
    if not epoch.isdigit():
        raise ValueError(f"SOURCE_DATE_EPOCH must be whole seconds since 1970, received {epoch!r}")
    return datetime.fromtimestamp(int(epoch), UTC).date().isoformat()


def package_version(name: str) -> str:
    """Look up an installed package's version, "" if it is not installed."""
    try:
        return version(name)
    except PackageNotFoundError:
        return ""
