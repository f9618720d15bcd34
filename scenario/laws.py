"""From [[law]] tables to law objects; CasADi is imported only when a law is built."""

from __future__ import annotations

import sys
from collections.abc import Mapping
from contextlib import redirect_stdout
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction
from keyword import iskeyword
from pathlib import Path
from typing import TYPE_CHECKING, final

from ..models.laws import LAWS
from .document import Document
from .errors import ScenarioError, quote
from .schema import LawDefaultsTable, LawTable, ScenarioFile

if TYPE_CHECKING:
    from ..models.laws import Law, Parameter

USER = "user"


def parameter_names() -> tuple[str, ...]:
    """Names of the parameters of all built-in laws."""
    return tuple(dict.fromkeys(name for law in LAWS.values() for name in law.described()))


@final
@dataclass(frozen=True)
class LawChoice:
    """One law of a scenario, not yet built.

    Attributes
    ----------
    type : a key of `LAWS`, or "user"
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

    def described(self) -> Mapping[str, Parameter]:
        """What the law says of its parameters: unit, bound, meaning (loads a user's file)."""
        return law_class(self).described()

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
        keywords = {(f"{n}_" if iskeyword(n) else n): v for n, v in self.parameters}
        if self.type == USER:
            from .user_code import complaint
            from .user_law import require_sound_law

            assert self.file is not None
            assert self.class_name is not None
            own = law_class(self)
            try:
                with redirect_stdout(sys.stderr):
                    law = own(**keywords)
            except (TypeError, ValueError) as error:
                raise ScenarioError(f"{self.where}.parameters", f"{self.class_name}: {error}") from None
            except KeyboardInterrupt:
                raise
            except BaseException as error:  # whatever the user's own code does
                raise complaint(error, self.file, f"{self.where}.class", self.class_name) from error
            require_sound_law(law, self.file, f"{self.where}.class")
            return law
        try:
            return law_class(self)(**keywords)
        except ValueError as error:
            raise ScenarioError(self.where, str(error)) from None


def law_class(choice: LawChoice) -> type[Law]:
    """Return the class of a law (runs a user's file).

    Raises
    ------
    ScenarioError
        If a user's law cannot be loaded.
    """
    if choice.type != USER:
        return LAWS[choice.type]
    from .user_law import load_law_class

    assert choice.file is not None
    assert choice.class_name is not None
    return load_law_class(choice.file, choice.class_name, choice.where)


def build(file: ScenarioFile, document: Document) -> tuple[LawChoice, ...]:
    """Choices of all [[law]] tables, parameters completed from [law_defaults].

    Raises
    ------
    ScenarioError
        For an unknown type, a missing or stray parameter, or a label used twice.
    """
    for name in _given(file.law_defaults):
        if name not in parameter_names():
            where = document.where(f"law_defaults.{name}")
            raise ScenarioError(where, f"unknown key{_nearest(name, parameter_names())}")
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
    if table.type not in LAWS:
        names = ", ".join(f'"{name}"' for name in (*LAWS, USER))
        near = get_close_matches(table.type.replace("_", "-").lower(), [*LAWS, USER], n=1, cutoff=0.7)
        hint = f' (did you mean "{near[0]}"?)' if near else ""
        raise ScenarioError(f"{where}.type", f"expected one of {names}, received {quote(table.type)}{hint}")
    for stray, unwanted in (("file", table.file), ("class", table.class_), ("parameters", table.parameters)):
        if unwanted is not None:
            raise ScenarioError(f"{where}.{stray}", 'belongs to type = "user": remove it')
    given, wanted = _given(table), LAWS[table.type].described()
    for name in given:
        if name not in wanted:
            raise ScenarioError(f"{where}.{name}", _stray(name, table.type, wanted))
    values = [(name, _value(name, wanted[name], given, file, document, where)) for name in wanted]
    return LawChoice(table.type, table.label or table.type, tuple(values), None, None, where)


def _value(
    name: str,
    known: Parameter,
    given: Mapping[str, Fraction],
    file: ScenarioFile,
    document: Document,
    where: str,
) -> Fraction:
    """Value of one parameter: the law's table's, else [law_defaults]', else the law's own default."""
    defaults = _given(file.law_defaults)
    value = given.get(name, defaults.get(name, known.default))
    if value is None:
        raise ScenarioError(f"{where}.{name}", "required (here or in [law_defaults]), but missing")
    try:
        known.require(value)
    except ValueError as error:
        place = f"{where}.{name}" if name in given else document.where(f"law_defaults.{name}")
        raise ScenarioError(place, str(error)) from None
    return value


def _stray(name: str, law: str, wanted: Mapping[str, Parameter]) -> str:
    """Say of a key of a [[law]] table that it is no parameter of the law, or no key at all."""
    if name in parameter_names():
        return f'a law of type "{law}" has no such parameter (it has {", ".join(wanted)})'
    return "unknown key" + _nearest(
        name, (*(f.alias or n for n, f in LawTable.model_fields.items()), *wanted)
    )


def _nearest(name: str, known: tuple[str, ...]) -> str:
    near = get_close_matches(name, known, n=1)
    return f" (did you mean '{near[0]}'?)" if near else f" (known: {', '.join(known)})"


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


def _given(table: LawTable | LawDefaultsTable) -> dict[str, Fraction]:
    """Parameters that a table states, by the name the user writes."""
    return dict(table.model_extra or {})
