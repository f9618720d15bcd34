"""From [[law]] tables to law objects; CasADi is imported only when a law is built."""

from __future__ import annotations

import sys
from contextlib import redirect_stdout
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, final

from .document import Document
from .errors import ScenarioError, quote
from .schema import LawTable, ScenarioFile

if TYPE_CHECKING:
    from ..models.laws import Law

DEFAULTS: dict[str, dict[str, Fraction | None]] = {
    "adaptive-scaling": {"lambda": None, "gamma": None, "R0": None, "k0": None, "a": Fraction(1)},
    "adaptive-scaling-as-printed": {"lambda": None, "gamma": None, "R0": None, "k0": None},
    "persistence-filter": {"lambda": None, "R0": None},
    "persistence-filter-as-printed": {"lambda": None, "R0": None},
    "quaternion-pd": {"proportional": None, "derivative": None},
}
"""Parameters of every built-in type with their defaults; None: the file must give them."""

USER = "user"
PARAMETERS = ("lambda", "gamma", "R0", "k0", "a", "proportional", "derivative")


@final
@dataclass(frozen=True)
class LawChoice:
    """One law of a scenario, not yet built.

    Attributes
    ----------
    type : a key of `DEFAULTS`, or "user"
    label : name in tables and figures, unique in the scenario
    parameters : exact values by name ("lambda", "R0", ...)
    file, class_name : the user's own law
    where : how messages name it
    """

    type: str
    label: str
    parameters: tuple[tuple[str, Fraction], ...]
    file: Path | None
    class_name: str | None
    where: str

    def parameter(self, name: str) -> Fraction:
        """Exact value of a parameter."""
        return dict(self.parameters)[name]

    def with_parameters(self, **changes: Fraction) -> LawChoice:
        """Return the same law with some parameters changed ('lambda_' stands for 'lambda')."""
        values = dict(self.parameters)
        for name, value in changes.items():
            key = name.rstrip("_")
            if key not in values:
                raise ValueError(f"law {self.label} has no parameter {key}")
            values[key] = Fraction(value)
        return LawChoice(self.type, self.label, tuple(values.items()), self.file, self.class_name, self.where)

    def build(self) -> Law:
        """Return the law object (imports CasADi).

        Raises
        ------
        ScenarioError
            If a user's law cannot be loaded or does not take these parameters.
        """
        keywords = {("lambda_" if n == "lambda" else n): v for n, v in self.parameters}
        if self.type == USER:
            from .user_code import complaint
            from .user_law import load_law_class, require_sound_law

            assert self.file is not None
            assert self.class_name is not None
            law_class = load_law_class(self.file, self.class_name, self.where)
            try:
                with redirect_stdout(sys.stderr):
                    law = law_class(**keywords)
            except (TypeError, ValueError) as error:
                raise ScenarioError(f"{self.where}.parameters", f"{self.class_name}: {error}") from None
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # whatever the user's own code does
                raise complaint(error, self.file, f"{self.where}.class", self.class_name) from error
            require_sound_law(law, self.file, f"{self.where}.class")
            return law
        from ..models.laws import LAWS

        try:
            return LAWS[self.type](**keywords)
        except ValueError as error:
            raise ScenarioError(self.where, str(error)) from None


def build(file: ScenarioFile, document: Document) -> tuple[LawChoice, ...]:
    """Choices of all [[law]] tables, parameters completed from [law_defaults].

    Raises
    ------
    ScenarioError
        For an unknown type, a missing or stray parameter, or a label used twice.
    """
    choices: list[LawChoice] = []
    labels: set[str] = set()
    single = isinstance(document.tables.get("law"), dict)
    for index, table in enumerate(file.law):
        key = "law" if single else f"law[{index + 1}]"
        choice = _choice(table, file, document, key)
        if choice.label in labels:
            raise ScenarioError(
                document.where(f"{key}.label"),
                f"{quote(choice.label)} is used twice: give each law its own label",
            )
        labels.add(choice.label)
        choices.append(choice)
    return tuple(choices)


def _choice(table: LawTable, file: ScenarioFile, document: Document, key: str) -> LawChoice:
    where = document.where(key)
    if table.type == USER:
        return _user_choice(table, document, key)
    if table.type not in DEFAULTS:
        known = ", ".join(f'"{name}"' for name in (*DEFAULTS, USER))
        raise ScenarioError(f"{where}.type", f"expected one of {known}, received {quote(table.type)}")
    for stray, unwanted in (("file", table.file), ("class", table.class_), ("parameters", table.parameters)):
        if unwanted is not None:
            raise ScenarioError(f"{where}.{stray}", 'belongs to type = "user": remove it')
    given, defaults = _given(table), _given(file.law_defaults)
    wanted = DEFAULTS[table.type]
    for name in given:
        if name not in wanted:
            raise ScenarioError(
                f"{where}.{name}",
                f'a law of type "{table.type}" has no such parameter (it has {", ".join(wanted)})',
            )
    values: list[tuple[str, Fraction]] = []
    for name, default in wanted.items():
        value = given.get(name, defaults.get(name, default))
        if value is None:
            raise ScenarioError(f"{where}.{name}", "required (here or in [law_defaults]), but missing")
        values.append((name, value))
    return LawChoice(table.type, table.label or table.type, tuple(values), None, None, where)


def _user_choice(table: LawTable, document: Document, key: str) -> LawChoice:
    where = document.where(key)
    for name in _given(table):
        raise ScenarioError(
            f"{where}.{name}", "a user's law takes its numbers in `parameters`: move it there"
        )
    if table.file is None or table.class_ is None:
        missing = "file" if table.file is None else "class"
        raise ScenarioError(f"{where}.{missing}", 'required with type = "user", but missing')
    path = document.origin("law").parent / table.file
    parameters = tuple((table.parameters or {}).items())
    return LawChoice(USER, table.label or table.class_, parameters, path, table.class_, where)


def _given(table: object) -> dict[str, Fraction]:
    """Parameters that a table states, by the name the user writes."""
    values = {name: getattr(table, "lambda_" if name == "lambda" else name, None) for name in PARAMETERS}
    return {name: value for name, value in values.items() if value is not None}
