"""Stand-alone checker of certificate files: standard library only, exact rationals throughout.

    python -I -S checker.py FILE

A certificate file is JSON, every number in it an exact string ("p/q" or a decimal):

    {"format": "intermit-certificate", "version": "1", "parts": [
      {"data": {...},                               what the claims of this part speak about
       "certificates": [{"kind": ..., "claim": {...}, "witness": {...}}, ...]}, ...]}

The checker proves each claim anew from the file alone: what a certificate says of itself counts
for nothing, and a field that no proof reads makes the file invalid. It prints each claim with
its data and VALID or INVALID with the reason. Exit code 0: everything is valid; 1: something is
not; 2: there is no such file. It shares no code with the programs that write certificates.

Order of this file: exact numbers, reading, the table of kinds, exact matrices, then one section
for each kind of certificate, then the command line.
"""

from __future__ import annotations

import json
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import Any

FORMAT = "intermit-certificate"
VERSION = "1"

Vector = list[Fraction]
Matrix = list[list[Fraction]]


class Invalid(Exception):  # noqa: N818 (it is the word printed)
    """A certificate that proves nothing, with the reason."""


# --- exact numbers ---------------------------------------------------------------------------

_NUMBER = re.compile(r"[+-]?[0-9]+(?:/0*[1-9][0-9]*|(?:\.[0-9]+)?(?:[eE][+-]?[0-9]{1,4})?)")


def exact(text: object) -> Fraction:
    """Return the rational number that a string or an integer of the file stands for."""
    if isinstance(text, int) and not isinstance(text, bool):
        return Fraction(text)
    if not isinstance(text, str) or not _NUMBER.fullmatch(text):
        raise Invalid(f"expected an exact number as a string, received {str(text)[:40]!r}")
    return Fraction(text)


def show(value: Fraction) -> str:
    """Return the number for people: exact if short, else to 12 digits with a sign of rounding."""
    if len(str(value)) <= 14:
        denominator = value.denominator
        while denominator % 2 == 0:
            denominator //= 2
        while denominator % 5 == 0:
            denominator //= 5
        return f"{float(value):.12g}" if denominator == 1 else str(value)
    return f"~{float(value):.12g}"


# --- reading ---------------------------------------------------------------------------------


class Node:
    """One place in the file; it remembers what has been read, so that nothing rides along unread."""

    def __init__(self, value: Any, path: str) -> None:
        self.path = path
        self._value = value
        self._children: dict[str, Node] = {}
        self._whole = False

    def __getitem__(self, key: str) -> Node:
        """Return the member of that name."""
        if not isinstance(self._value, dict) or key not in self._value:
            raise Invalid(f"{self.path}: field {key!r} is missing")
        return self._child(key, self._value[key])

    def _child(self, key: str, value: Any) -> Node:
        if key not in self._children:
            self._children[key] = Node(value, f"{self.path}.{key}")
        return self._children[key]

    def has(self, key: str) -> bool:
        """Whether there is a member of that name."""
        return isinstance(self._value, dict) and key in self._value

    def keys(self) -> list[str]:
        """Names of the members, in the file's order."""
        if not isinstance(self._value, dict):
            raise Invalid(f"{self.path}: expected an object")
        return list(self._value)

    def items(self) -> list[Node]:
        """Entries of a list."""
        return [self._child(str(i), value) for i, value in enumerate(self._list())]

    def _list(self) -> list[Any]:
        if not isinstance(self._value, list):
            raise Invalid(f"{self.path}: expected a list")
        return self._value

    def text(self) -> str:
        """Return a piece of text."""
        self._whole = True
        if not isinstance(self._value, str):
            raise Invalid(f"{self.path}: expected text")
        return self._value

    def number(self) -> Fraction:
        """Return an exact number."""
        self._whole = True
        try:
            return exact(self._value)
        except Invalid as error:
            raise Invalid(f"{self.path}: {error}") from None

    def integer(self, low: int = 0, high: int = 10**9) -> int:
        """Return an integer in [low, high]."""
        value = self.number()
        if value.denominator != 1 or not low <= value <= high:
            raise Invalid(f"{self.path}: expected an integer from {low} to {high}, received {show(value)}")
        return int(value)

    def vector(self, length: int | None = None) -> Vector:
        """Return a list of exact numbers."""
        self._whole = True
        try:
            values = [exact(x) for x in self._list()]
        except Invalid as error:
            raise Invalid(f"{self.path}: {error}") from None
        if length is not None and len(values) != length:
            raise Invalid(f"{self.path}: expected {length} numbers, received {len(values)}")
        return values

    def matrix(self, rows: int | None = None, columns: int | None = None) -> Matrix:
        """Return a list of equally long rows of exact numbers."""
        table = [row.vector(columns) for row in self.items()]
        if rows is not None and len(table) != rows:
            raise Invalid(f"{self.path}: expected {rows} rows, received {len(table)}")
        if len({len(row) for row in table}) > 1:
            raise Invalid(f"{self.path}: rows differ in length")
        return table

    def unread(self) -> Iterator[str]:
        """Paths of the fields that nothing has read."""
        if self._whole:
            return
        if isinstance(self._value, dict):
            members = list(self._value.items())
        elif isinstance(self._value, list):
            members = [(str(i), value) for i, value in enumerate(self._value)]
        else:
            yield self.path
            return
        for key, value in members:
            if key in self._children:
                yield from self._children[key].unread()
            elif value not in ({}, []):
                yield f"{self.path}.{key}"


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) != len(pairs):
        raise Invalid("a field is given twice")
    return members


def _no_float(text: str) -> Any:
    raise Invalid(f"the number {text[:40]} must be an exact string")


def parse(text: str) -> Node:
    """Parse a certificate file."""
    try:
        value = json.loads(text, object_pairs_hook=_unique, parse_float=_no_float, parse_constant=_no_float)
    except (ValueError, RecursionError) as error:
        raise Invalid(f"not JSON: {error}") from None
    return Node(value, "file")


# --- the table of kinds ----------------------------------------------------------------------

Check = Callable[[Node, Node], list[str]]
"""(data, certificate) -> the claim in words, line by line; raises Invalid if the proof fails."""

KINDS: dict[str, Check] = {}


def kind(name: str) -> Callable[[Check], Check]:
    """Enter a function into the table under the name that certificates give as their kind."""

    def enter(check: Check) -> Check:
        KINDS[name] = check
        return check

    return enter


def require(condition: bool, reason: str) -> None:
    """Raise Invalid with the reason unless the condition holds."""
    if not condition:
        raise Invalid(reason)


@dataclass(frozen=True)
class Finding:
    """The checker's word on one certificate."""

    kind: str
    valid: bool
    claim: tuple[str, ...]
    reason: str


def check_text(text: str) -> list[Finding]:
    """Check everything in a certificate file."""
    try:
        file = parse(text)
        require(file["format"].text() == FORMAT, f"the format must be {FORMAT!r}")
        require(file["version"].text() == VERSION, f"this checker reads version {VERSION!r}")
        pairs = [
            (part["data"], one) for part in file["parts"].items() for one in part["certificates"].items()
        ]
        require(bool(pairs), "there is no certificate in the file")
    except Invalid as error:
        return [Finding("file", False, (), str(error))]
    findings = [_check_one(data, certificate) for data, certificate in pairs]
    stray = list(file.unread())
    if stray and all(finding.valid for finding in findings):
        reason = f"nothing reads {', '.join(stray[:5])}"
        findings.append(Finding("file", False, (), reason))
    return findings


def _check_one(data: Node, certificate: Node) -> Finding:
    name = "unknown"
    try:
        name = certificate["kind"].text()
        require(name in KINDS, f"this checker knows no certificate of kind {name!r}")
        return Finding(name, True, tuple(KINDS[name](data, certificate)), "")
    except Invalid as error:
        return Finding(name, False, (), str(error))
    except (ArithmeticError, LookupError, TypeError, ValueError, RecursionError) as error:
        return Finding(name, False, (), f"malformed: {type(error).__name__}: {error}")


# --- exact matrices --------------------------------------------------------------------------


def is_symmetric(A: Matrix) -> bool:
    """Whether a matrix is square and symmetric."""
    n = len(A)
    return all(len(row) == n for row in A) and all(A[i][j] == A[j][i] for i in range(n) for j in range(i))


def is_positive_semidefinite(A: Matrix) -> bool:
    """Decide x'Ax >= 0 for all x, exactly, by symmetric elimination."""
    if not is_symmetric(A):
        return False
    A = [list(row) for row in A]
    n = len(A)
    for k in range(n):
        pivot = A[k][k]
        if pivot < 0 or (pivot == 0 and any(A[i][k] != 0 for i in range(k + 1, n))):
            return False
        if pivot == 0:
            continue
        for i in range(k + 1, n):
            factor = A[i][k] / pivot
            if factor:
                for j in range(k + 1, n):
                    A[i][j] -= factor * A[k][j]
    return True


def is_positive_definite(A: Matrix) -> bool:
    """Decide x'Ax > 0 for all x != 0, exactly: every pivot of the elimination is positive."""
    if not is_symmetric(A):
        return False
    A = [list(row) for row in A]
    n = len(A)
    for k in range(n):
        if A[k][k] <= 0:
            return False
        for i in range(k + 1, n):
            factor = A[i][k] / A[k][k]
            for j in range(k + 1, n):
                A[i][j] -= factor * A[k][j]
    return True


def read_inertia(data: Node) -> Matrix:
    """Return the inertia matrix of the data, kg m^2, checked to be symmetric and positive definite."""
    J = data["inertia"].matrix(3, 3)
    require(is_positive_definite(J), "the inertia is not symmetric and positive definite")
    return J


def show_matrix(A: Sequence[Sequence[Fraction]]) -> str:
    """Return a matrix for people."""
    return "[" + ", ".join("[" + ", ".join(show(x) for x in row) + "]" for row in A) + "]"


# --- kind: condition on lambda -----------------------------------------------------------------


@kind("sharp-condition")
def check_sharp_condition(data: Node, certificate: Node) -> list[str]:
    """Decide lambda >= sqrt(a)/(2 sqrt(Jmin)), that is 4 lambda^2 J - a I >= 0 with lambda > 0."""
    J = read_inertia(data)
    lam, a = data["parameters"]["lambda"].number(), certificate["claim"]["weight"].number()
    require(lam > 0 and a > 0, "lambda and the weight a must be positive")
    gap = [[4 * lam**2 * J[i][j] - (a if i == j else 0) for j in range(3)] for i in range(3)]
    require(is_positive_semidefinite(gap), "4 lambda^2 J - a I is not positive semidefinite")
    return [
        f"lambda >= sqrt(a)/(2 sqrt(Jmin)) for lambda = {show(lam)} 1/s, a = {show(a)} kg m^2/s^2,",
        f"inertia J = {show_matrix(J)} kg m^2",
    ]


# --- command line ------------------------------------------------------------------------------


def report(findings: list[Finding]) -> str:
    """Return the findings as text."""
    lines: list[str] = []
    for finding in findings:
        lines.append(f"{'VALID' if finding.valid else 'INVALID'}  {finding.kind}")
        lines += [f"    {line}" for line in finding.claim]
        if finding.reason:
            lines.append(f"    reason: {finding.reason}")
    good = sum(finding.valid for finding in findings)
    lines.append(f"{good} of {len(findings)} valid")
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str]) -> int:
    """Check the file named on the command line and return the exit code."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -I -S checker.py FILE\n")
        return 2
    sys.set_int_max_str_digits(0)
    try:
        text = Path(arguments[0]).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        sys.stderr.write(f"cannot read {arguments[0]}: {error}\n")
        return 2
    findings = check_text(text)
    sys.stdout.write(report(findings))
    return 0 if all(finding.valid for finding in findings) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
