"""Whether a valid certificate file speaks of a scenario: everything its claims rest on, compared exactly."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...scenario import Scenario
from ...verify.certificates import as_text
from ...verify.certificates.facts import windows_data
from ...verify.certificates.program import NotAlgebraicError
from ...verify.certificates.schedule import schedule_data
from ...verify.checker import Invalid, exact, same_law
from ...verify.filter.adaptive import AdaptiveProof
from ...verify.filter.certificate import FLOOR, WITHOUT_FILTER, set_data
from ...verify.filter.persistence import PersistenceProof
from ...verify.filter.recognise import (
    ComparedLaw,
    NoComparisonError,
    compared_law,
    follows_filter,
    has_resets,
)
from ...verify.linear.stability import plant_data
from ...verify.lyapunov.forms import inertia_data, law_form
from ...verify.robust.certificate import uncertainty_data
from ...verify.schedule.filter_start import greatest_gain_at
from ...verify.schedule.zero_runs import default_length
from ..optimum.lower_bounds import transfers_data
from ..optimum.nominal import nominal_words

BOUND = "peak-lower-bound"
CONDITIONS = ("sharp-condition", "paper-condition")
FILTER_STARTS = ("filter-start", "filter-start-counterexample")


def differences(text: str, scenario: Scenario) -> tuple[str, ...]:
    """How a valid certificate file differs from a scenario; empty if it speaks of the scenario.

    Every part of the file must agree with one law of the scenario in everything it says. A law is
    compared as polynomials, so that neither its name nor the order of its instructions matters.
    """
    parts = json.loads(text)["parts"]
    transfers = transfers_data(scenario) if any("transfer" in part["data"] for part in parts) else []
    known = [_Known.of(scenario, law, transfers) for law in _laws(scenario)]
    found: list[str] = []
    for number, part in enumerate(parts, start=1):
        gaps = sorted((list(_unequal(part, one)) for one in known), key=len)
        if gaps[0]:
            found.append(f"part {number}: {', '.join(gaps[0])}")
    return tuple(found)


def uncovered(text: str, scenario: Scenario) -> tuple[str, ...]:
    """Parts that speak of the nominal body alone where the scenario knows it within a tolerance."""
    words = nominal_words(scenario)
    parts = json.loads(text)["parts"]
    bounds = [n for n, part in enumerate(parts, start=1) if BOUND in _kinds(part)]
    return tuple(f"part {number}: the bound of the peak is {words}" for number in bounds if words)


def _kinds(part: Mapping[str, Any]) -> set[str]:
    return {certificate["kind"] for certificate in part["certificates"]}


def _laws(scenario: Scenario) -> Sequence[Law | None]:
    return [choice.build() for choice in scenario.laws] or [None]


@final
@dataclass(frozen=True)
class _Known:
    """Everything certificates may say of a scenario with one of its laws, as they say it.

    Attributes
    ----------
    data : entries that are compared word by word
    law : the law's equations, or None where there are none, or none of + - * / alone
    compared : the law as the comparison theorem knows it, if it does
    filter : (R(0), lambda) where R is the persistence filter
    resets : whether the law's states jump
    """

    scenario: Scenario
    data: Mapping[str, Any]
    transfers: Sequence[Any]
    law: Mapping[str, Any] | None
    compared: ComparedLaw | None
    filter: Mapping[str, Any]
    resets: bool

    @classmethod
    def of(cls, scenario: Scenario, law: Law | None, transfers: Sequence[object]) -> _Known:
        """Put together what certificates may say."""
        data: dict[str, object] = {"schedule": schedule_data(scenario.schedule)}
        data |= windows_data(scenario.schedule)
        data |= inertia_data(scenario.body.exact_inertia, scenario.inertia_tolerance)
        data["uncertainty"] = uncertainty_data(scenario.uncertainty)
        if scenario.linear is not None:
            data |= plant_data(scenario.linear)
        form = compared = None
        start: dict[str, object] = {}
        if law is not None:
            loop = close_loop(law)
            data["initial_set"] = set_data(scenario.initial_set)
            data["parameters"] = law.parameters
            initial = {state.name: state.initial for state in law.controller_states}
            data["initial"] = initial
            with suppress(NotAlgebraicError):  # such a law has no certificate that writes it out
                form = law_form(loop)
            with suppress(NoComparisonError):
                compared = compared_law(law)
            if follows_filter(loop):
                start = {"lambda": law.parameters["lambda"], "R0": initial["R"]}
        resets = law is not None and has_resets(law)
        return cls(
            scenario, as_text(data), as_text(transfers), as_text(form) if form is not None else None,
            compared, as_text(start), resets,
        )  # fmt: skip


def _unequal(part: Mapping[str, Any], known: _Known) -> Iterator[str]:
    """Names of what the scenario does not confirm."""
    stated, kinds = part["data"], _kinds(part)
    missing = "inertia_tolerance" in known.data and "inertia_tolerance" not in stated
    if missing and "inertia" in stated and kinds != {BOUND}:  # of a bound `uncovered` says it
        yield "inertia_tolerance (the scenario has one, the certificate none)"
    old = "law" in stated and "program" not in stated["law"]
    parameters = known.data.get("parameters", {})
    if kinds <= {*FILTER_STARTS}:
        parameters = known.filter
    if old:
        parameters = _by_name(stated["law"], known)
    for key, value in stated.items():
        if key == "law":
            if not old and not (known.law is not None and same_law(value, known.law)):
                yield "law"
            if known.resets:
                yield "law (the scenario's law resets its states)"
        elif key == "transfer":
            if not any(_same(value, transfer) for transfer in known.transfers):
                yield "transfer"
        elif key == "parameters":
            for name, number in value.items():
                if not _same(number, parameters.get(name)):
                    yield f"parameters.{name}"
        elif not _same(value, known.data.get(key)):
            yield key
    if FLOOR in kinds and "initial" not in stated:  # earlier versions: among the parameters
        start = known.data.get("initial", {})
        if any(not _same(stated["parameters"].get(f"{name}0"), value) for name, value in start.items()):
            yield "initial"
    if kinds & {*FILTER_STARTS} and not known.filter:
        yield "R (the scenario's law has no state that obeys R' = -lambda R + g^2 (1 + b0))"
    if kinds & {*FILTER_STARTS} and not all(
        _same(stated["parameters"].get(name), value) for name, value in known.filter.items()
    ):
        yield "R(0) or lambda of the filter"
    if kinds & {*CONDITIONS} and not _same(stated["parameters"]["lambda"], known.filter.get("lambda")):
        yield "lambda of the filter"
    for certificate in part["certificates"]:
        yield from _unequal_claim(certificate, known)


def _by_name(law: Mapping[str, Any], known: _Known) -> Mapping[str, str]:
    """Parameters that the equations meant by a name must have (files of earlier versions hold no program)."""
    found = known.compared
    if found is None or law.get("name") != (AdaptiveProof if found.adaptive else PersistenceProof).name:
        return {}
    values = {"lambda": found.decay, "R0": found.initial_filter}
    if found.adaptive:
        values |= {"gamma": found.learning_rate, "a": found.weight, "k0": found.initial_gain}
    return dict(as_text(values))


def _unequal_claim(certificate: Mapping[str, Any], known: _Known) -> Iterator[str]:
    """Names of what a claim assumes beside the data, and the scenario does not say."""
    kind, claim, scenario = certificate["kind"], certificate["claim"], known.scenario
    schedule = scenario.schedule
    if kind in (FLOOR, WITHOUT_FILTER, "robust-floor"):
        tolerance = as_text({"attitude": scenario.tolerance.attitude, "rate": scenario.tolerance.rate})
        settling = claim.get("settling", {})
        for name, value in tolerance.items():
            if name in settling and not _same(settling[name], value):
                yield f"settling.{name}"
        if "horizon" in claim and schedule.period is not None:
            yield "horizon (the scenario's schedule repeats for ever)"
    elif kind == "schedule-excitation":
        length = scenario.check.pe_window or default_length(schedule)
        if exact(claim["length"]) != length:
            yield "length of the moving integral"
    elif kind == "sharp-condition":
        adaptive = known.compared is not None and known.compared.adaptive
        weight = known.compared.weight if known.compared is not None and adaptive else Fraction(1)
        if exact(claim["weight"]) != weight:
            yield "weight a of the condition"
    elif kind == "lyapunov-derivative" and "gain_bound" in claim:
        least: Fraction = greatest_gain_at(schedule)[0]
        if exact(claim["gain_bound"]) < least:
            yield "gain_bound (the scenario's g exceeds it)"


def _same(left: Any, right: Any) -> bool:
    """Whether two nested values hold the same exact numbers and text."""
    if isinstance(left, Mapping) and isinstance(right, Mapping):
        return left.keys() == right.keys() and all(_same(left[key], right[key]) for key in left)
    if isinstance(left, list) and isinstance(right, list):
        return len(left) == len(right) and all(map(_same, left, right))
    try:
        return exact(left) == exact(right)
    except Invalid:
        return type(left) is type(right) and bool(left == right)
