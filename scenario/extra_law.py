"""A user's own law named on the command line: FILE:CLASS, with parameters, beside a scenario's laws."""

from __future__ import annotations

from dataclasses import replace
from hashlib import sha256
from pathlib import Path

from .errors import ScenarioError, quote
from .exact import exact_from_text
from .files import read_text
from .laws import USER, LawChoice
from .scenario import Scenario


def law_from_words(words: str) -> LawChoice:
    """Read 'FILE:CLASS' or 'FILE:CLASS,name=value,...', e.g. 'my_law.py:MyLaw,stiffness=0.1'.

    The label is the class, or what `label=...` says. Values are exact decimals.

    Raises
    ------
    ScenarioError
        If the words have another form, or a value is not a number.
    """
    head, *rest = words.split(",")
    file, colon, name = head.rpartition(":")
    where = f"law {quote(words)}"
    if not colon or not file or not name.strip().isidentifier():
        raise ScenarioError(where, "expected FILE:CLASS, or FILE:CLASS,name=value,...")
    label = name.strip()
    parameters = []
    for part in rest:
        key, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals or not key.isidentifier():
            raise ScenarioError(where, f"expected name=value, received {quote(part)}")
        if key == "label":
            label = value
            continue
        try:
            parameters.append((key, exact_from_text(value)))
        except ValueError as error:
            raise ScenarioError(f"{where}: {key}", str(error)) from None
    return LawChoice(USER, label, tuple(parameters), Path(file), name.strip(), where)


def with_laws(scenario: Scenario, *choices: LawChoice) -> Scenario:
    """Return the scenario with more laws; its hash changes with their files and parameters.

    Raises
    ------
    ScenarioError
        If a label is taken or a law's file cannot be read.
    """
    labels = [law.label for law in scenario.laws]
    digest = sha256(scenario.sha256.encode())
    for choice in choices:
        if choice.label in labels:
            raise ScenarioError(choice.where, f"the label {quote(choice.label)} is taken: add label=...")
        labels.append(choice.label)
        words = [choice.type, choice.label, str(choice.class_name)]
        words += [f"{name}={value}" for name, value in choice.parameters]
        if choice.file is not None:
            words.append(read_text(choice.file, f"{choice.where}: {choice.file}"))
        digest.update("\0".join(words).encode())
    return replace(scenario, laws=(*scenario.laws, *choices), sha256=digest.hexdigest())
