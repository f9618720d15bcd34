"""Stand-alone checker of certificate files: standard library only, exact rationals throughout.

    python -I -S checker.py FILE

A certificate file is JSON, every number in it an exact string ("p/q" or a decimal):

    {"format": "intermit-certificate", "version": "1", "parts": [
      {"data": {...},                               what the claims of this part speak about
       "certificates": [{"kind": ..., "claim": {...}, "witness": {...}}, ...]}, ...]}

The checker proves each claim anew from the file alone: what a certificate says of itself counts
for nothing, and a field that no proof reads makes the file invalid. It prints each claim with
its data and VALID or INVALID with the reason. Exit code 0: everything is valid; 1: something is
not; 2: there is no such file. It imports nothing from the programs that write certificates.

Order of this file: exact numbers, reading, the table of kinds, exact matrices, then one section
for each kind of certificate, then the command line.
"""

from __future__ import annotations

import json
import math
import re
import sys
from bisect import bisect_right
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise
from math import comb, isqrt, lcm
from operator import mul
from pathlib import Path
from typing import Any, TypeVar

FORMAT = "intermit-certificate"
VERSION = "1"

Vector = list[Fraction]
Matrix = list[list[Fraction]]
HALF = Fraction(1, 2)


class Invalid(Exception):  # noqa: N818 (it is the word printed)
    """A certificate that proves nothing, with the reason."""


# --- exact numbers ---------------------------------------------------------------------------

_NUMBER = re.compile(r"[+-]?[0-9]+(?:/0*[1-9][0-9]*|(?:\.[0-9]+)?(?:[eE]([+-]?[0-9]{1,4}))?)")
MAX_DIGITS = 4000
"""Of a number in the file. Longer ones are refused: a short file could otherwise be checked for ever."""


def exact(text: object) -> Fraction:
    """Return the rational number that a string or an integer of the file stands for."""
    if isinstance(text, int) and not isinstance(text, bool):
        return Fraction(text)
    if isinstance(text, str) and len(text) > MAX_DIGITS:
        raise Invalid(f"a number of {len(text)} characters: at most {MAX_DIGITS} digits are read")
    found = _NUMBER.fullmatch(text) if isinstance(text, str) else None
    if not isinstance(text, str) or found is None:
        raise Invalid(f"expected an exact number as a string, received {str(text)[:40]!r}")
    if abs(int(found[1] or 0)) + len(text) > MAX_DIGITS:
        raise Invalid(f"the number {text[:40]} has more than {MAX_DIGITS} digits")
    return Fraction(text)


def show(value: Fraction) -> str:
    """Return the number for people: exact if short, else to 12 digits with a sign of rounding."""
    if value.numerator.bit_length() + value.denominator.bit_length() < 60 and len(str(value)) <= 14:
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


def _integer(text: str) -> int:
    if len(text) > MAX_DIGITS:
        raise Invalid(f"a number of {len(text)} characters: at most {MAX_DIGITS} digits are read")
    return int(text)


def parse(text: str) -> Node:
    """Parse a certificate file."""
    try:
        value = json.loads(
            text,
            object_pairs_hook=_unique,
            parse_int=_integer,
            parse_float=_no_float,
            parse_constant=_no_float,
        )
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
    findings = [check_certificate(data, certificate) for data, certificate in pairs]
    stray = list(file.unread())
    if stray and all(finding.valid for finding in findings):
        reason = f"nothing reads {', '.join(stray[:5])}"
        findings.append(Finding("file", False, (), reason))
    return findings


def check_certificate(data: Node, certificate: Node) -> Finding:
    """Check one certificate against the data of its part."""
    name = "unknown"
    try:
        name = certificate["kind"].text()
        require(name in KINDS, f"this checker knows no certificate of kind {name!r}")
        return Finding(name, True, tuple(KINDS[name](data, certificate)), "")
    except Invalid as error:
        return Finding(name, False, (), str(error))
    except (ArithmeticError, LookupError, TypeError, ValueError, MemoryError, RecursionError) as error:
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
    lam, a = data["parameters"]["lambda"].number(), certificate["claim"]["weight"].number()
    require(lam > 0 and a > 0, "lambda and the weight a must be positive")
    for J, pivots in _with_factors(data, certificate, 4 * lam**2, a):
        require(all(d >= 0 for d in pivots), f"4 lambda^2 J - a I has a negative pivot, J = {show_matrix(J)}")
    return [
        f"lambda >= sqrt(a)/(2 sqrt(Jmin)) for lambda = {show(lam)} 1/s, a = {show(a)} kg m^2/s^2,",
        describe_inertia(data),
    ]


@kind("paper-condition")
def check_paper_condition(data: Node, certificate: Node) -> list[str]:
    """Decide lambda > max(1/(2 Jmin), 1/2), that is 2 lambda J - I > 0 and lambda > 1/2."""
    lam = data["parameters"]["lambda"].number()
    require(lam > Fraction(1, 2), "lambda must exceed 1/2")
    for J, pivots in _with_factors(data, certificate, 2 * lam, Fraction(1)):
        require(all(d > 0 for d in pivots), f"2 lambda J - I is not positive definite, J = {show_matrix(J)}")
    return [f"lambda > max(1/(2 Jmin), 1/2) for lambda = {show(lam)} 1/s,", describe_inertia(data)]


def _with_factors(
    data: Node, certificate: Node, factor: Fraction, shift: Fraction
) -> Iterator[tuple[Matrix, Vector]]:
    """Yield each vertex J and the pivots D of factor J - shift I = L D L', checked."""
    vertices, factors = inertia_vertices(data), certificate["witness"]["factors"].items()
    require(
        len(factors) == len(vertices), "expected one factorisation for each vertex of the box of inertias"
    )
    for J, place in zip(vertices, factors, strict=True):
        (l21, l31, l32), pivots = place["lower"].vector(3), place["pivots"].vector(3)
        L = [
            [Fraction(1), Fraction(0), Fraction(0)],
            [l21, Fraction(1), Fraction(0)],
            [l31, l32, Fraction(1)],
        ]
        for i in range(3):
            for j in range(i + 1):
                product = sum((L[i][k] * pivots[k] * L[j][k] for k in range(3)), Fraction(0))
                wanted = factor * J[i][j] - (shift if i == j else 0)
                require(product == wanted, f"{place.path}: L D L' is not the matrix of the condition")
        yield J, pivots


# --- exact polynomials -------------------------------------------------------------------------

Exponents = tuple[int, ...]


class Ring:
    """Polynomials in named symbols over the rationals; symbols known to be positive may be inverted."""

    def __init__(self, names: Sequence[str], invertible: Sequence[str] = ()) -> None:
        if len(set(names)) != len(names):
            raise Invalid("two symbols have one name")
        self.names = tuple(names)
        self.index = {name: i for i, name in enumerate(self.names)}
        self.invertible = frozenset(self.index[name] for name in invertible)
        self.one: Exponents = (0,) * len(self.names)

    def constant(self, value: Fraction | int) -> Poly:
        """Return a number as a polynomial."""
        return Poly(self, {self.one: Fraction(value)} if value else {})

    def symbol(self, name: str) -> Poly:
        """Return a symbol as a polynomial."""
        if name not in self.index:
            raise Invalid(f"there is no symbol {name!r} here")
        i = self.index[name]
        return Poly(self, {(*self.one[:i], 1, *self.one[i + 1 :]): Fraction(1)})


class Poly:
    """One (Laurent) polynomial: exponents -> coefficient, without zero coefficients."""

    __slots__ = ("ring", "terms")

    def __init__(self, ring: Ring, terms: dict[Exponents, Fraction]) -> None:
        self.ring = ring
        self.terms = terms

    def __add__(self, other: Poly) -> Poly:
        terms = dict(self.terms)
        for key, value in other.terms.items():
            total = terms.get(key, 0) + value
            if total:
                terms[key] = total
            else:
                terms.pop(key, None)
        return Poly(self.ring, terms)

    def __neg__(self) -> Poly:
        return Poly(self.ring, {key: -value for key, value in self.terms.items()})

    def __sub__(self, other: Poly) -> Poly:
        return self + (-other)

    def __mul__(self, other: Poly) -> Poly:
        require(len(self.terms) * len(other.terms) <= MAX_TERMS**2, "a polynomial has too many terms")
        terms: dict[Exponents, Fraction] = {}
        for left, a in self.terms.items():
            for right, b in other.terms.items():
                key = tuple(map(int.__add__, left, right))
                terms[key] = terms.get(key, 0) + a * b
        return Poly(self.ring, {key: value for key, value in terms.items() if value})

    def scaled(self, factor: Fraction | int) -> Poly:
        """Return factor times this."""
        return Poly(self.ring, {k: v * factor for k, v in self.terms.items()} if factor else {})

    def inverse(self) -> Poly:
        """Return 1 / this; only a number or a monomial of positive symbols has one."""
        if len(self.terms) != 1:
            raise Invalid("division by something that is not a monomial of positive symbols")
        ((key, value),) = self.terms.items()
        if any(e and i not in self.ring.invertible for i, e in enumerate(key)):
            raise Invalid("division by a symbol not known to be positive")
        return Poly(self.ring, {tuple(-e for e in key): 1 / value})

    def power(self, n: int) -> Poly:
        """Return the n-th power, n >= 0, or any n for a monomial of positive symbols."""
        if n < 0:
            return self.inverse().power(-n)
        result = self.ring.constant(1)
        for _ in range(n):
            result = result * self
        return result

    def derivative(self, name: str) -> Poly:
        """Return the partial derivative with respect to a symbol."""
        i = self.ring.index[name]
        terms = {(*k[:i], k[i] - 1, *k[i + 1 :]): v * k[i] for k, v in self.terms.items() if k[i]}
        return Poly(self.ring, terms)

    def substitute(self, name: str, value: Poly) -> Poly:
        """Replace a symbol by a polynomial."""
        i = self.ring.index[name]
        groups: dict[int, dict[Exponents, Fraction]] = {}
        for key, coefficient in self.terms.items():
            groups.setdefault(key[i], {})[(*key[:i], 0, *key[i + 1 :])] = coefficient
        result = self.ring.constant(0)
        for exponent, terms in groups.items():
            result = result + Poly(self.ring, terms) * value.power(exponent)
        return result

    def at(self, values: dict[str, Fraction]) -> Fraction:
        """Return the value at given numbers for the symbols that occur."""
        total = Fraction(0)
        for key, coefficient in self.terms.items():
            for name, e in zip(self.ring.names, key, strict=True):
                if e:
                    coefficient *= values[name] ** e
            total += coefficient
        return total

    def uses(self, name: str) -> bool:
        """Whether a symbol occurs."""
        i = self.ring.index[name]
        return any(key[i] for key in self.terms)

    def text(self, limit: int | None = None) -> str:
        """Return the polynomial for people, whole or its first terms only."""
        parts: list[str] = []
        for key, value in sorted(self.terms.items(), reverse=True)[:limit]:
            powers = [
                name + (f"^{e}" if e != 1 else "") for name, e in zip(self.ring.names, key, strict=True) if e
            ]
            factor = [] if abs(value) == 1 and powers else [show(abs(value))]
            parts.append(("- " if value < 0 else "+ ") + " ".join(factor + powers))
        if limit is not None and len(self.terms) > limit:
            parts.append(f"+ ... ({len(self.terms)} terms)")
        return " ".join(parts).removeprefix("+ ") or "0"


MAX_TERMS = 3000
MAX_POWER = 60
MAX_BASIS = 400
"""Terms of a polynomial, powers in it, monomials of a Gram matrix: beyond, checking could take for ever."""


def require_modest(p: Poly, path: str) -> None:
    """Refuse a polynomial whose powers or numbers have grown beyond anything a law needs."""
    require(len(p.terms) <= MAX_TERMS, f"{path}: a polynomial has too many terms")
    powers = (abs(e) for key in p.terms for e in key)
    require(max(powers, default=0) <= MAX_POWER, f"{path}: a power is too high")
    sizes = (v.numerator.bit_length() + v.denominator.bit_length() for v in p.terms.values())
    require(max(sizes, default=0) <= 8 * MAX_DIGITS, f"{path}: a number is too long")


def on_sphere(p: Poly) -> Poly:
    """Return the normal form on |b| = 1: c^2 = 2 c - b1^2 - b2^2 - b3^2, where c = 1 - b0."""
    ring = p.ring
    i = ring.index["c"]
    c = ring.symbol("c")
    square = c.scaled(2)
    for name in ("b1", "b2", "b3"):
        square = square - ring.symbol(name).power(2)
    while any(key[i] > 1 for key in p.terms):
        low = {key: v for key, v in p.terms.items() if key[i] < 2}
        high = {(*k[:i], k[i] - 2, *k[i + 1 :]): v for k, v in p.terms.items() if k[i] > 1}
        p = Poly(ring, low) + Poly(ring, high) * square
    return p


# --- programs: expressions as lines of text ------------------------------------------------------

_BINARY: dict[str, Callable[[Poly, Poly], Poly]] = {
    "add": lambda x, y: x + y,
    "sub": lambda x, y: x - y,
    "mul": lambda x, y: x * y,
    "div": lambda x, y: x * y.inverse(),
}
_UNARY: dict[str, Callable[[Poly], Poly]] = {
    "assign": lambda x: x,
    "neg": lambda x: -x,
    "sq": lambda x: x * x,
    "twice": lambda x: x.scaled(2),
    "inv": lambda x: x.inverse(),
}
_TARGET = re.compile(r"v[0-9]{1,7}")


def run(program: Node, ring: Ring, symbols: dict[str, Poly]) -> dict[str, Poly]:
    """Carry out a program: lines "v7 = mul b1 v3" or "v2 = const 1/2", each name assigned once."""
    values = dict(symbols)
    for line in program.items():
        words = line.text().split()
        require(len(words) in (4, 5) and words[1] == "=", f"{line.path}: not an instruction")
        target, operation, operands = words[0], words[2], words[3:]
        require(
            bool(_TARGET.fullmatch(target)) and target not in values, f"{line.path}: {target} assigned twice"
        )
        if operation == "const" and len(operands) == 1:
            values[target] = ring.constant(exact(operands[0]))
            continue
        require(all(name in values for name in operands), f"{line.path}: an operand is not defined")
        if operation in _UNARY and len(operands) == 1:
            values[target] = _UNARY[operation](values[operands[0]])
        elif operation in _BINARY and len(operands) == 2:
            values[target] = _BINARY[operation](values[operands[0]], values[operands[1]])
        else:
            raise Invalid(f"{line.path}: there is no operation {operation!r} of {len(operands)} operands")
        require_modest(values[target], line.path)
    return values


def pick(values: dict[str, Poly], place: Node) -> Poly:
    """Return the value that a place in the file names."""
    name = place.text()
    require(name in values, f"{place.path}: {name!r} is not defined")
    return values[name]


# --- the closed loop: rigid body, law and storage function -----------------------------------------

INERTIA = ("J11", "J12", "J13", "J22", "J23", "J33")
ATTITUDE = ("b1", "b2", "b3")
RATE = ("y1", "y2", "y3")
RESERVED = frozenset(
    (
        "b0",
        "w1",
        "w2",
        "w3",
        "u1",
        "u2",
        "u3",
        "V",
        "W",
        "c",
        "s",
        "g",
        "g_rate",
        "k_target",
        "weight",
        *ATTITUDE,
        *RATE,
        *INERTIA,
    )
)
"""Names that laws may not give to their states, signals and parameters."""
Triple = list[Poly]


Entry = TypeVar("Entry", int, Fraction, Poly)


def cross(x: Sequence[Entry], y: Sequence[Entry]) -> list[Entry]:
    """Return x cross y."""
    return [x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]]


def total(terms: Sequence[Poly], ring: Ring) -> Poly:
    """Return the sum."""
    result = ring.constant(0)
    for term in terms:
        result = result + term
    return result


def apply(A: Sequence[Sequence[Poly]], x: Triple, ring: Ring) -> Triple:
    """Return the product of a 3 by 3 matrix and a vector."""
    return [total([A[i][j] * x[j] for j in range(3)], ring) for i in range(3)]


@dataclass(frozen=True)
class Loop:
    """Symbols of one closed loop, in the coordinates (c, b, y): c = 1 - b0, y = w + shift.

    Attributes
    ----------
    states, signals : names of the controller states, and of the law's functions of time
    J : entries of the inertia, symbols or numbers
    symbols : what programs may use, except the rate w
    """

    ring: Ring
    states: tuple[str, ...]
    signals: tuple[str, ...]
    J: Sequence[Sequence[Poly]]
    symbols: dict[str, Poly]


def read_loop(data: Node, storage: Node, *, symbolic: bool, J: Matrix | None) -> Loop:
    """Set up the symbols for a law: its parameters as positive symbols or numbers, J symbols or numbers."""
    law = data["law"]
    weight = storage["weight"].number() if storage.has("weight") else None
    states = tuple(node.text() for node in law["states"].items())
    signals = tuple(node.text() for node in law["signals"].items())
    parameters = [node.text() for node in law["parameters"].items()]
    timed = [name for signal in signals for name in (signal, f"{signal}_rate")]
    require_names([*states, *timed, *parameters])
    positive = ["k_target", *(["R"] if "R" in states else []), *(["weight", *parameters] if symbolic else [])]
    names = ["k_target", "s", *(["weight", *parameters] if symbolic else []), *states, "g", "g_rate", *timed]
    names += ["c", *ATTITUDE, *RATE, *(INERTIA if J is None else ())]
    ring = Ring(names, positive)
    symbols = {name: ring.symbol(name) for name in names if name not in ("c", "s", *RATE)}
    symbols["b0"] = ring.constant(1) - ring.symbol("c")
    for name in parameters:
        value = data["parameters"][name].number() if not symbolic else None
        require(name not in symbols or symbolic, f"the name {name!r} is used twice")
        if value is not None:
            symbols[name] = ring.constant(value)
    if weight is not None and not symbolic:
        require(weight > 0 and "weight" not in symbols, "the weight must be positive, and no parameter")
        symbols["weight"] = ring.constant(weight)
    entries = dict(zip(INERTIA, _upper(J, ring, symbols), strict=True))
    symbols.update(entries)
    table = [[entries[f"J{min(i, j)}{max(i, j)}"] for j in (1, 2, 3)] for i in (1, 2, 3)]
    return Loop(ring, states, signals, table, symbols)


def require_names(names: Sequence[str]) -> None:
    """Refuse names with a meaning of their own, and what is no name and would read as words of a claim."""
    for name in names:
        require(name.isidentifier() and len(name) <= 60, f"{name[:60]!r} is no name for a symbol")
        require(
            name not in RESERVED and not _TARGET.fullmatch(name),
            f"the name {name!r} has a meaning of its own",
        )


def _upper(J: Matrix | None, ring: Ring, symbols: dict[str, Poly]) -> list[Poly]:
    if J is None:
        return [symbols[name] for name in INERTIA]
    return [ring.constant(J[i][j]) for i in range(3) for j in range(i, 3)]


def law_polynomials(law: Node) -> dict[str, dict[Exponents, Fraction]]:
    """Return torque and controller rates of a law as polynomials, and its lists of names, for comparison."""
    result = {str(i): p.terms for i, p in enumerate(law_values(law))}
    return result | {f"{key} {name}": {} for key, names in _law_names(law).items() for name in names}


def _law_names(law: Node) -> dict[str, tuple[str, ...]]:
    keys = ("parameters", "states", "signals")
    return {key: tuple(node.text() for node in law[key].items()) for key in keys}


def law_values(law: Node) -> list[Poly]:
    """Return torque and controller rates of a law as polynomials in the symbols that laws may use."""
    lists = _law_names(law)
    timed = [f"{name}{end}" for name in lists["signals"] for end in ("", "_rate")]
    require_names([*lists["states"], *timed, *lists["parameters"]])
    names = ["b0", *ATTITUDE, "w1", "w2", "w3", *lists["states"], "g", "g_rate", *timed]
    names += [*lists["parameters"], *INERTIA]
    ring = Ring(names, [name for name in names if name == "R" or name in lists["parameters"]])
    values = run(law["program"], ring, {name: ring.symbol(name) for name in names})
    places = [*law["torque"].items(), *(law["rates"][name] for name in lists["states"])]
    return [pick(values, place) for place in places]


@dataclass(frozen=True)
class Motion:
    """The closed loop in the coordinates (c, b, y): w, the rates of everything but y, and J y'."""

    rate: Triple
    torque: Triple
    rates: dict[str, Poly]
    momentum: Triple


def move(loop: Loop, law: Node, shift: Triple) -> Motion:
    """Derive the motion for y = w + shift from the law and the equations of the rigid body.

    b0' = -bv.w/2, bv' = (b0 w + bv x w)/2, J w' = -w x J w + g u: these three lines are the
    checker's own.
    """
    ring, symbols = loop.ring, loop.symbols
    w = [ring.symbol(name) - shift[i] for i, name in enumerate(RATE)]
    known = {name: value for name, value in symbols.items() if name not in ("k_target", "weight")}
    control = run(law["program"], ring, known | {f"w{i + 1}": w[i] for i in range(3)})
    torque = [pick(control, place) for place in law["torque"].items()]
    require(len(torque) == 3, "the torque must have three components")
    b, b0 = [ring.symbol(name) for name in ATTITUDE], symbols["b0"]
    turn = cross(b, w)
    rates = {"c": total([b[i] * w[i] for i in range(3)], ring).scaled(Fraction(1, 2))}
    rates |= {ATTITUDE[i]: (b0 * w[i] + turn[i]).scaled(Fraction(1, 2)) for i in range(3)}
    rates |= {name: pick(control, law["rates"][name]) for name in loop.states}
    rates |= {name: symbols[f"{name}_rate"] for name in ("g", *loop.signals)}
    gyro = cross(w, apply(loop.J, w, ring))
    momentum = [symbols["g"] * torque[i] - gyro[i] for i in range(3)]
    shift_rate = apply(loop.J, [along(p, rates) for p in shift], ring)
    momentum = [on_sphere(momentum[i] + shift_rate[i]) for i in range(3)]
    return Motion(w, torque, rates, momentum)


def along(p: Poly, rates: dict[str, Poly]) -> Poly:
    """Return the derivative of a polynomial that is free of y."""
    return total([p.derivative(name) * rate for name, rate in rates.items() if p.uses(name)], p.ring)


@dataclass(frozen=True)
class Derivative:
    """V and its derivative along the closed loop, the reference W, and the shift y - w."""

    value: Poly
    rate: Poly
    outputs: dict[str, Poly]
    shift: Triple


def differentiate(loop: Loop, law: Node, storage: Node) -> Derivative:
    """Derive V' from the law, the storage function and the equations of the rigid body."""
    ring, symbols = loop.ring, loop.symbols
    free = run(storage["shift_program"], ring, symbols)
    shift = [pick(free, place) for place in storage["shift"].items()]
    plain = len(shift) == 3 and not any(_uses_a_rate(loop, p) for p in shift)
    require(plain, "the shift must be three functions of the state, g and the signals")
    true_name(loop, law)
    motion = move(loop, law, shift)
    known = {**symbols, **{f"w{i + 1}": motion.rate[i] for i in range(3)}}
    outputs = run(storage["program"], ring, known)
    value = on_sphere(pick(outputs, storage["value"]))
    require(not _uses_a_rate(loop, value), "the storage function must not use g' or the rate of a signal")
    gradient = _momentum_gradient(loop, storage, outputs, [value.derivative(name) for name in RATE])
    turning = total([gradient[i] * motion.momentum[i] for i in range(3)], ring)
    rate = along(value, motion.rates) + turning
    return Derivative(value, on_sphere(rate), outputs, shift)


def _uses_a_rate(loop: Loop, p: Poly) -> bool:
    return any(p.uses(f"{name}_rate") for name in ("g", *loop.signals))


def _momentum_gradient(loop: Loop, storage: Node, outputs: dict[str, Poly], gradient: Triple) -> Triple:
    """Return q with J q = dV/dy: as the file gives it, checked; or by the inverse of a numeric J."""
    if storage.has("momentum_gradient"):
        q = [pick(outputs, place) for place in storage["momentum_gradient"].items()]
        product = apply(loop.J, q, loop.ring)
        require(
            len(q) == 3 and all(not on_sphere(product[i] - gradient[i]).terms for i in range(3)),
            "J times the momentum gradient is not dV/dy",
        )
        return q
    one = loop.ring.one
    require(
        all(entry.terms.keys() <= {one} for row in loop.J for entry in row), "J has no inverse in symbols"
    )
    numbers = [[entry.terms.get(one, Fraction(0)) for entry in row] for row in loop.J]
    inverse = [[loop.ring.constant(x) for x in row] for row in inverse_matrix(numbers)]
    return apply(inverse, gradient, loop.ring)


def inverse_matrix(A: Matrix) -> Matrix:
    """Return the inverse of a positive definite 3 by 3 matrix."""
    cofactor = [
        [
            A[(i + 1) % 3][(j + 1) % 3] * A[(i + 2) % 3][(j + 2) % 3]
            - A[(i + 1) % 3][(j + 2) % 3] * A[(i + 2) % 3][(j + 1) % 3]
            for j in range(3)
        ]
        for i in range(3)
    ]
    determinant = sum((A[0][j] * cofactor[0][j] for j in range(3)), Fraction(0))
    return [[cofactor[j][i] / determinant for j in range(3)] for i in range(3)]


# --- laws by their equations -------------------------------------------------------------------
#
# A name in the file proves nothing. Names of the laws below may stand there only beside a program that
# has their equations. What is printed is the name of the known law that a program is, else its equations.


def augmented(loop: Loop, kappa: Poly) -> Triple:
    """2 g^2 kappa bv, the shift from w to Omega."""
    g = loop.ring.symbol("g")
    return [(g * g * kappa * loop.ring.symbol(name)).scaled(2) for name in ATTITUDE]


def gain_of(loop: Loop) -> Poly:
    """Kappa of the family: the state k where there is one, else 1/R."""
    known = ("R",), ("R", "k"), ("k", "R")
    require(loop.states in known, "its controller states are not R, or R and k")
    return loop.ring.symbol("k") if "k" in loop.states else loop.ring.symbol("R").inverse()


def excess(loop: Loop, motion: Motion, kappa: Poly) -> Triple:
    """J Omega' + Omega x J w + (g^2/2) kappa (1 + b0) J Omega: zero for the laws of the family."""
    ring, y = loop.ring, [loop.ring.symbol(name) for name in RATE]
    g, room = ring.symbol("g"), ring.constant(2) - ring.symbol("c")
    gyro, Jy = cross(y, apply(loop.J, motion.rate, ring)), apply(loop.J, y, ring)
    pull = (g * g * kappa * room).scaled(HALF)
    return [on_sphere(motion.momentum[i] + gyro[i] + pull * Jy[i]) for i in range(3)]


def filter_slope(loop: Loop, lam: Poly) -> Poly:
    """-lambda R + g^2 (1 + b0)."""
    ring, g = loop.ring, loop.ring.symbol("g")
    return g * g * (ring.constant(2) - ring.symbol("c")) - lam * ring.symbol("R")


def gain_slope(loop: Loop, gamma: Poly, a: Poly) -> Poly:
    """Return gamma R g^2 [(1 + b0) Omega'J Omega + 2 a |bv|^2]."""
    ring = loop.ring
    y, b = [ring.symbol(name) for name in RATE], [ring.symbol(name) for name in ATTITUDE]
    Jy, g = apply(loop.J, y, ring), ring.symbol("g")
    energy = total([y[i] * Jy[i] for i in range(3)], ring) * (ring.constant(2) - ring.symbol("c"))
    square = total([x * x for x in b], ring) * a.scaled(2)
    return gamma * ring.symbol("R") * g * g * (energy + square)


def true_name(loop: Loop, law: Node) -> str:
    """Return the name of the known law whose equations a program has; empty if it is none of them.

    The name of a known law beside other equations is refused; any other counts for nothing.
    """
    label = law["name"].text() if law.has("name") else ""
    if label in NAMED:
        same = not loop.signals and NAMED[label](loop, law)
        require(same, f"the program of the file is not the law {label}")
        return label
    return "" if loop.signals else next((name for name, same in NAMED.items() if same(loop, law)), "")


def _is_persistence_filter(loop: Loop, law: Node) -> bool:
    return loop.states == ("R",) and _is_scaled(loop, law, printed=False)


def _is_printed_filter(loop: Loop, law: Node) -> bool:
    return loop.states == ("R",) and _is_scaled(loop, law, printed=True)


def _is_adaptive_scaling(loop: Loop, law: Node) -> bool:
    known = all(name in loop.symbols for name in ("gamma", "a"))
    if not known or sorted(loop.states) != ["R", "k"] or not _is_scaled(loop, law, printed=False):
        return False
    motion = move(loop, law, augmented(loop, gain_of(loop)))
    slope = gain_slope(loop, loop.symbols["gamma"], loop.symbols["a"])
    return not on_sphere(motion.rates["k"] - slope).terms


def _is_scaled(loop: Loop, law: Node, *, printed: bool) -> bool:
    """Whether R is the filter and Omega moves as in the family; `printed`: no J in the term of kappa'."""
    if "lambda" not in loop.symbols:
        return False
    kappa, ring = gain_of(loop), loop.ring
    motion = move(loop, law, augmented(loop, kappa))
    rest = excess(loop, motion, kappa)
    if printed:
        g, b = ring.symbol("g"), [ring.symbol(name) for name in ATTITUDE]
        slope, Jb = along(kappa, motion.rates), apply(loop.J, b, ring)
        missing = [(g * g * slope * (Jb[i] - b[i])).scaled(2) for i in range(3)]
        rest = [on_sphere(rest[i] - missing[i]) for i in range(3)]
    slope = filter_slope(loop, loop.symbols["lambda"])
    return not any(p.terms for p in (*rest, on_sphere(motion.rates["R"] - slope)))


def _is_quaternion_pd(loop: Loop, law: Node) -> bool:
    gains = [loop.symbols.get(name) for name in ("proportional", "derivative")]
    if loop.states or gains[0] is None or gains[1] is None:
        return False
    motion = move(loop, law, [loop.ring.constant(0)] * 3)
    pairs = zip(ATTITUDE, motion.rate, motion.torque, strict=True)
    return not any(on_sphere(u + gains[0] * loop.ring.symbol(b) + gains[1] * w).terms for b, w, u in pairs)


def _is_free_motion(loop: Loop, law: Node) -> bool:
    return not loop.states and not any(p.terms for p in move(loop, law, [loop.ring.constant(0)] * 3).torque)


def _is_not_algebraic(loop: Loop, law: Node) -> bool:
    del loop, law
    return False


NAMED: dict[str, Callable[[Loop, Node], bool]] = {
    "persistence-filter": _is_persistence_filter,
    "persistence-filter-as-printed": _is_printed_filter,
    "adaptive-scaling": _is_adaptive_scaling,
    "adaptive-scaling-as-printed": _is_not_algebraic,
    "quaternion-pd": _is_quaternion_pd,
    "free-motion": _is_free_motion,
}
"""Laws that may be called by name, with the test of a program."""


@dataclass(frozen=True)
class Compared:
    """A law that the comparison theorem of the floor is about, read off its equations.

    `gain` is a key of `LOOPS`; lam, gamma and a are numbers in the equations, whatever the file calls them.
    """

    gain: str
    lam: Fraction
    gamma: Fraction
    a: Fraction


def compared_law(data: Node) -> Compared:
    """Return which law of the family the program of the data is, proved for every inertia."""
    law = data["law"]
    loop = read_loop(data, Node({}, "storage"), symbolic=False, J=None)
    kappa, ring = gain_of(loop), loop.ring
    adaptive = "k" in loop.states
    true_name(loop, law)
    motion = move(loop, law, augmented(loop, kappa))
    words = "k" if adaptive else "1/R"
    for p in excess(loop, motion, kappa):
        require(
            not p.terms,
            f"its torque does not give J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega for "
            f"Omega = w + 2 g^2 kappa bv, kappa = {words}",
        )
    zero, one = ring.constant(0), ring.constant(1)
    rest = on_sphere(motion.rates["R"] - filter_slope(loop, zero))
    lam = -rest.terms.get(next(iter(ring.symbol("R").terms)), Fraction(0))
    same = not (rest + ring.symbol("R").scaled(lam)).terms
    require(same and lam > 0, "its state R does not obey R' = -lambda R + g^2 (1 + b0) with lambda > 0")
    if not adaptive:
        return Compared("persistence-filter", lam, Fraction(0), Fraction(0))
    slope = on_sphere(motion.rates["k"])
    unit, other = on_sphere(gain_slope(loop, one, zero)), on_sphere(gain_slope(loop, one, one))
    first = next(iter(unit.terms))
    gamma = slope.terms.get(first, Fraction(0)) / unit.terms[first]
    second = next(iter((other - unit).terms))
    a = slope.terms.get(second, Fraction(0)) / (other - unit).terms[second] / (gamma or 1)
    same = not (slope - unit.scaled(gamma) - (other - unit).scaled(gamma * a)).terms
    require(
        same and gamma > 0 and a > 0,
        "its state k does not obey k' = gamma R g^2 [(1 + b0) Omega'J Omega + 2 a |bv|^2] with gamma, a > 0",
    )
    return Compared("adaptive-scaling", lam, gamma, a)


def describe_law(data: Node, *, symbolic: bool) -> str:
    """Return the law for people: by the known law that it is, else by its equations; and its numbers."""
    law = data["law"]
    loop = read_loop(data, Node({}, "storage"), symbolic=symbolic, J=None)
    name = true_name(loop, law)
    words = f"law {name}" if name else f"law {law_equations(law)}"
    names = [node.text() for node in law["parameters"].items()]
    if symbolic:
        return ", ".join([words, f"every {', '.join(names)} > 0"] if names else [words])
    return ", ".join([words, *(f"{n} = {show(data['parameters'][n].number())}" for n in names)])


def law_equations(law: Node) -> str:
    """Return torque and rates of the states, in the symbols of the file."""
    values = dict(zip(("u1", "u2", "u3"), law_values(law)[:3], strict=True))
    states = [node.text() for node in law["states"].items()]
    values |= {f"{name}'": p for name, p in zip(states, law_values(law)[3:], strict=True)}
    return ", ".join(f"{name} = {p.text()}" for name, p in values.items())


# --- kind: identity of the derivative ----------------------------------------------------------


@kind("lyapunov-identity")
def check_lyapunov_identity(data: Node, certificate: Node) -> list[str]:
    """V' equals a given expression identically, for every inertia and all positive parameters."""
    law, storage = data["law"], certificate["claim"]["storage"]
    loop = read_loop(data, storage, symbolic=True, J=None)
    result = differentiate(loop, law, storage)
    claimed = on_sphere(pick(result.outputs, storage["right_side"]))
    rest = on_sphere(result.rate - claimed)
    require(not rest.terms, f"V' differs from the claimed expression by {rest.text(6)}")
    return [
        f"V' = {claimed.text()}",
        f"identically, for V = {result.value.text()},",
        f"y = w + ({', '.join(p.text() for p in result.shift)}), c = 1 - b0,",
        f"{describe_law(data, symbolic=True)}, every inertia",
    ]


# --- kind: sign of the derivative --------------------------------------------------------------


@kind("lyapunov-derivative")
def check_lyapunov_derivative(data: Node, certificate: Node) -> list[str]:
    """V' <= -rho W on the whole domain, for every inertia of the box: sums of squares, exactly.

    -V' - rho W is written as a sum of (factors known to be >= 0) times (z'Gz with G positive
    semidefinite), as an identity on the unit sphere of quaternions, once for each vertex of the
    box of inertias (-V' - rho W is affine in J there).
    """
    claim = certificate["claim"]
    rho = claim["rate"].number()
    require(rho >= 0, "the rate must not be negative")
    problems = list(gaps(data, claim))
    sums = certificate["witness"]["sums"].items()
    require(len(sums) == len(problems), "expected one sum of squares for each vertex of the box of inertias")
    for (gap, reference), place in zip(problems, sums, strict=True):
        rest = on_sphere(gap - reference.scaled(rho) - _sum_of_squares(gap.ring, place, claim))
        require(not rest.terms, f"{place.path}: the sum of squares differs by {rest.text(4)}")
    return [
        f"V' <= -{show(rho)} W on every attitude and rate, {_domain_text(data, claim)},",
        *_about(data, claim),
    ]


def gaps(data: Node, claim: Node) -> Iterator[tuple[Poly, Poly]]:
    """Derive (-V', W) on the domain of the claim, at each vertex of the box of inertias."""
    storage, boxed = claim["storage"], data.has("inertia_tolerance")
    vertices = inertia_vertices(data)
    loop = read_loop(data, storage, symbolic=False, J=None if boxed else vertices[0])
    ring = loop.ring
    result = differentiate(loop, data["law"], storage)
    pair = [-result.rate, on_sphere(pick(result.outputs, storage["reference"]))]
    if _read_domain(loop, claim):
        level = (ring.constant(1) + ring.symbol("s")) * ring.symbol("k_target").inverse()
        pair = [p.substitute("R", level) for p in pair]
    for J in vertices:
        at = [on_sphere(_at_inertia(p, loop, J if boxed else None)) for p in pair]
        yield at[0], at[1]


def _about(data: Node, claim: Node) -> list[str]:
    """Return what V, W and the coordinates are, with the law and the inertia."""
    J = None if data.has("inertia_tolerance") else read_inertia(data)
    loop = read_loop(data, claim["storage"], symbolic=False, J=J)
    result = differentiate(loop, data["law"], claim["storage"])
    return [
        f"for V = {result.value.text()},",
        f"W = {on_sphere(pick(result.outputs, claim['storage']['reference'])).text()},",
        f"y = w + ({', '.join(p.text() for p in result.shift)}), c = 1 - b0,",
        describe_law(data, symbolic=False) + ",",
        describe_inertia(data),
    ]


def _domain_text(data: Node, claim: Node) -> str:
    states = [node.text() for node in data["law"]["states"].items()]
    where = "R > 0" if "R" in states else "all controller states"
    if claim["domain"].text() == "above floor":
        where = "R >= R_min for any R_min > 0, k_target = 1/R_min"
    if not claim.has("gain_bound"):
        return where
    bound = claim["gain_bound"].number()
    require(bound > 0, "the bound on g must be positive")
    return f"{where}, 0 <= g <= {show(bound)}"


def inertia_vertices(data: Node) -> list[Matrix]:
    """Return the inertias at the vertices of the box of tolerances, or the one given, checked definite."""
    J = read_inertia(data)
    if not data.has("inertia_tolerance"):
        return [J]
    radius = data["inertia_tolerance"].matrix(3, 3)
    require(
        is_symmetric(radius) and all(x >= 0 for row in radius for x in row),
        "tolerances must be >= 0, symmetric",
    )
    places = [(i, j) for i in range(3) for j in range(i, 3) if radius[i][j] > 0]
    vertices = []
    for number in range(2 ** len(places)):
        vertex = [list(row) for row in J]
        for bit, (i, j) in enumerate(places):
            vertex[i][j] = J[i][j] + (radius[i][j] if number >> bit & 1 else -radius[i][j])
            vertex[j][i] = vertex[i][j]
        require(is_positive_definite(vertex), "an inertia within the tolerance is not positive definite")
        vertices.append(vertex)
    return vertices


def describe_inertia(data: Node) -> str:
    """Return the inertia for people."""
    text = f"inertia J = {show_matrix(data['inertia'].matrix())} kg m^2"
    if data.has("inertia_tolerance"):
        text += f" +- {show_matrix(data['inertia_tolerance'].matrix())}"
    return text


def _read_domain(loop: Loop, claim: Node) -> bool:
    """Whether the claim is about R >= R_min = 1/k_target; otherwise about R > 0."""
    word = claim["domain"].text()
    require(word in ("above floor", "everywhere"), f"there is no domain {word!r}")
    require(word == "everywhere" or "R" in loop.states, "the law has no filter state R")
    return word == "above floor"


def _at_inertia(p: Poly, loop: Loop, J: Matrix | None) -> Poly:
    """Return a polynomial, affine in the entries of J, at one inertia."""
    if J is None:
        return p
    where = [loop.ring.index[name] for name in INERTIA]
    require(
        all(sum(map(abs, (k[i] for i in where))) <= 1 for k in p.terms),
        "-V' - rho W is not affine in the inertia",
    )
    for name in INERTIA:
        i, j = int(name[1]) - 1, int(name[2]) - 1
        p = p.substitute(name, loop.ring.constant(J[i][j]))
    return p


def _sum_of_squares(ring: Ring, place: Node, claim: Node) -> Poly:
    """Return sum of factors times z'Gz, every G checked to be positive semidefinite."""
    result = ring.constant(0)
    for term in place.items():
        basis = [_monomial(ring, node.text()) for node in term["basis"].items()]
        require(len(basis) <= MAX_BASIS, f"{term.path}: the basis is too long")
        gram = term["gram"].matrix(len(basis), len(basis))
        require(is_positive_semidefinite(gram), f"{term.path}: the Gram matrix is not positive semidefinite")
        form = ring.constant(0)
        for i, left in enumerate(basis):
            row = total([basis[j].scaled(gram[i][j]) for j in range(len(basis))], ring)
            form = form + left * row
        result = result + _factor(ring, term["factors"], claim) * form
    return result


def _monomial(ring: Ring, text: str) -> Poly:
    result = ring.constant(1)
    for name in text.split():
        if name != "1":
            result = result * ring.symbol(name)
    return result


def _factor(ring: Ring, factors: Node, claim: Node) -> Poly:
    """Return a product of powers, each known to be >= 0 on the domain of the claim."""
    floor = claim["domain"].text() == "above floor"
    result = ring.constant(1)
    names = factors.keys()
    for name in names:
        power = factors[name].integer(-50, 50)
        if name == "k_target" or (name == "R" and not floor and ring.index.get("R") in ring.invertible):
            base = ring.symbol(name)
        elif name == "s" and floor and power >= 0:
            base = ring.symbol("s")
        elif name == "1-b0" and power >= 0:
            base = ring.symbol("c")
        elif name == "1+b0" and power >= 0:
            base = ring.constant(2) - ring.symbol("c")
        elif name in ("g", "gmax-g") and power >= 0:
            bound = claim["gain_bound"].number()
            require(bound > 0, "the bound on g must be positive")
            base = ring.symbol("g") if name == "g" else ring.constant(bound) - ring.symbol("g")
        elif name in ring.index and power >= 0 and power % 2 == 0:
            base = ring.symbol(name)
        else:
            raise Invalid(f"{factors.path}: {name}^{power} is not known to be >= 0")
        result = result * base.power(power)
    return result


# --- kind: counterexample to the sign of the derivative ------------------------------------------


@kind("lyapunov-counterexample")
def check_lyapunov_counterexample(data: Node, certificate: Node) -> list[str]:
    """V' > 0 at a given state of the domain, for an inertia within the tolerance."""
    claim = certificate["claim"]
    state, J = claim["state"], _claimed_inertia(data, claim)
    loop = read_loop(data, claim["storage"], symbolic=False, J=J)
    result = differentiate(loop, data["law"], claim["storage"])
    quaternion, w = state["quaternion"].vector(4), state["rate"].vector(3)
    require(sum(x * x for x in quaternion) == 1, "the quaternion is not of unit norm")
    values = dict(zip(("c", *ATTITUDE), (1 - quaternion[0], *quaternion[1:]), strict=True))
    values |= {name: state["controller"][name].number() for name in loop.states}
    timed = ("g", *loop.signals)
    values |= {name: state[name].number() for name in (*timed, *(f"{name}_rate" for name in timed))}
    values["k_target"] = state["k_target"].number()
    require(values["g"] >= 0 and values["k_target"] > 0, "g must not be negative, k_target positive")
    least = 1 / values["k_target"] if _read_domain(loop, claim) else Fraction(0)
    if "R" in loop.states:
        require(values["R"] >= least and values["R"] > 0, "R is below its range")
    values |= {name: w[i] + result.shift[i].at(values) for i, name in enumerate(RATE)}
    rate = result.rate.at(values)
    require(rate > 0, f"V' = {show(rate)} at the state is not positive")
    attitude, body_rate = show_matrix([quaternion]), show_matrix([w])
    shown = (*loop.states, *(f"{name}{end}" for name in timed for end in ("", "_rate")), "k_target")
    others = [f"{name} = {show(values[name])}" for name in shown]
    return [
        f"V' = {show(rate)} > 0 at quaternion {attitude}, rate {body_rate} rad/s,",
        ", ".join(others) + ",",
        f"for V = {result.value.text()},",
        f"y = w + ({', '.join(p.text() for p in result.shift)}), c = 1 - b0,",
        f"{describe_law(data, symbolic=False)}, inertia J = {show_matrix(J)} kg m^2",
    ]


def _claimed_inertia(data: Node, claim: Node) -> Matrix:
    """Return the inertia that a claim names, checked to lie within the tolerance; else the data's own."""
    nominal = read_inertia(data)
    if not claim.has("inertia"):
        return nominal
    J, radius = claim["inertia"].matrix(3, 3), data["inertia_tolerance"].matrix(3, 3)
    within = all(abs(J[i][j] - nominal[i][j]) <= radius[i][j] for i in range(3) for j in range(3))
    require(within and is_positive_definite(J), "the inertia is not within the tolerance")
    return J


# --- polynomials on [0, 1] in scaled Bernstein form ----------------------------------------------


class Form:
    """p(x) = sum_j a_j x^j (1 - x)^(n - j) / scale, a_j integers, scale > 0: exact, products convolve."""

    __slots__ = ("a", "scale")

    def __init__(self, a: list[int], scale: int = 1) -> None:
        self.a, self.scale = a, scale

    @classmethod
    def of(cls, controls: Sequence[Fraction]) -> Form:
        """Return the polynomial with these Bernstein coefficients."""
        scale, n = lcm(*(c.denominator for c in controls)), len(controls) - 1
        return cls([comb(n, j) * int(c * scale) for j, c in enumerate(controls)], scale)

    @classmethod
    def constant(cls, value: Fraction | int) -> Form:
        """Return a constant."""
        return cls.of([Fraction(value)])

    def elevated(self, degree: int) -> list[int]:
        """Scaled coefficients of the same polynomial with a formal degree."""
        extra = degree + 1 - len(self.a)
        return self.a if extra == 0 else _convolve(self.a, [comb(extra, j) for j in range(extra + 1)])

    def __add__(self, other: Form) -> Form:
        n = max(len(self.a), len(other.a)) - 1
        if self.scale == other.scale:
            return Form([x + y for x, y in zip(self.elevated(n), other.elevated(n), strict=True)], self.scale)
        p, q = other.scale, self.scale
        pairs = zip(self.elevated(n), other.elevated(n), strict=True)
        return Form([x * p + y * q for x, y in pairs], self.scale * other.scale)

    def __neg__(self) -> Form:
        return Form([-x for x in self.a], self.scale)

    def __sub__(self, other: Form) -> Form:
        return self + (-other)

    def __mul__(self, other: Form) -> Form:
        return Form(_convolve(self.a, other.a), self.scale * other.scale)

    def times(self, factor: Fraction | int) -> Form:
        """Return a multiple."""
        factor = Fraction(factor)
        return Form([x * factor.numerator for x in self.a], self.scale * factor.denominator)

    def derivative(self) -> Form:
        """Return dp/dx."""
        n = len(self.a) - 1
        if n == 0:
            return Form([0])
        return Form([(j + 1) * self.a[j + 1] - (n - j) * self.a[j] for j in range(n)], self.scale)

    def plain(self) -> tuple[list[int], int]:
        """Bernstein coefficients as integers over one positive denominator."""
        n = len(self.a) - 1
        common = lcm(*(comb(n, j) for j in range(n + 1)))
        return [x * (common // comb(n, j)) for j, x in enumerate(self.a)], self.scale * common

    def is_nonnegative(self, depth: int = 6) -> bool:
        """Whether p >= 0 on [0, 1] follows from Bernstein coefficients after some halvings."""
        return min(self.a) >= 0 or _nonnegative(self.plain()[0], depth)

    def is_at_least(self, value: Fraction, depth: int = 6) -> bool:
        """Whether p >= value on [0, 1] follows likewise."""
        return (self - Form.constant(value)).is_nonnegative(depth)


def _convolve(p: list[int], q: list[int]) -> list[int]:
    result = [0] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        if x:
            for j, y in enumerate(q):
                result[i + j] += x * y
    return result


def _nonnegative(controls: list[int], depth: int) -> bool:
    if min(controls) >= 0:
        return True
    if depth == 0 or controls[0] < 0 or controls[-1] < 0:
        return False
    return all(_nonnegative(half, depth - 1) for half in halves(controls))


def halves(controls: list[int]) -> tuple[list[int], list[int]]:
    """Bernstein coefficients of both halves, by de Casteljau, times 2^degree."""
    row, left, right = controls, [], []
    for power in range(len(controls) - 1, -1, -1):
        left.append(row[0] << power)
        right.append(row[-1] << power)
        row = [x + y for x, y in pairwise(row)]
    return left, right[::-1]


# --- schedules -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class Profile:
    """g on [0, end]: piece i is the polynomial shapes[i] of (t - knots[i])/(knots[i+1] - knots[i])."""

    knots: Vector
    shapes: list[Vector]
    period: Fraction | None

    def gain(self, start: Fraction, stop: Fraction) -> Form:
        """Return g on [start, stop], which must lie within one piece; zero beyond a finite table."""
        offset = Fraction(0)
        if self.period is not None:
            offset = start // self.period * self.period
        elif start >= self.knots[-1]:
            return Form([0])
        a, b = start - offset, stop - offset
        i = bisect_right(self.knots, a) - 1
        require(i + 1 < len(self.knots) and b <= self.knots[i + 1], "a step crosses a knot of the schedule")
        if not any(self.shapes[i]):
            return Form([0])
        length = self.knots[i + 1] - self.knots[i]
        shift, slope = (a - self.knots[i]) / length, (b - a) / length
        local: Vector = []
        for c in reversed(self.shapes[i]):
            local = _times_affine(local, shift, slope)
            local[0] += c
        return from_powers(local)

    def side(self, t: Fraction, *, after: bool) -> tuple[Fraction, Fraction]:
        """Return g and its slope just after, or just before, an instant of [0, end]; 0 before a table."""
        end, still = self.knots[-1], (Fraction(0), Fraction(0))
        if after and t == end:
            if self.period is None:
                return still
            t = Fraction(0)
        if not after and t == 0:
            if self.period is None:
                return still
            t = end
        i = bisect_right(self.knots, t) - 1
        i -= 1 if not after and self.knots[i] == t else 0
        length = self.knots[i + 1] - self.knots[i]
        x, value, slope = (t - self.knots[i]) / length, Fraction(0), Fraction(0)
        for c in reversed(self.shapes[i]):
            slope = slope * x + value
            value = value * x + c
        return value, slope / length


def from_powers(p: Vector) -> Form:
    """Return the polynomial on [0, 1] with these power coefficients, lowest first."""
    n = len(p) - 1
    terms = [[Fraction(comb(i, j), comb(n, j)) * p[j] for j in range(i + 1)] for i in range(n + 1)]
    return Form.of([sum(row, Fraction(0)) for row in terms])


def _times_affine(p: Vector, shift: Fraction, slope: Fraction) -> Vector:
    result = [Fraction(0)] * (len(p) + 1)
    for j, c in enumerate(p):
        result[j] += c * shift
        result[j + 1] += c * slope
    return result


def read_profile(data: Node) -> Profile:
    """Read the schedule of the data."""
    node = data["schedule"]
    knots = node["knots"].vector()
    table = [row.vector() for row in node["shapes"].items()]
    places = node["pieces"].vector(len(knots) - 1)
    require(all(x.denominator == 1 for x in places), "a piece must name a shape by its number")
    use = [int(x) for x in places]
    require(all(0 <= i < len(table) for i in use), "a piece names a shape that is not there")
    require(knots[0] == 0 and all(a < b for a, b in pairwise(knots)), "knots must increase from 0")
    require(bool(table), "there are no shapes")
    require(all(len(row) <= MAX_COUNT for row in table), "a shape has too many coefficients")
    require(
        all(from_powers(row or [Fraction(0)]).is_nonnegative() for row in table),
        "the gain is not proved >= 0",
    )
    period = node["period"].number() if node.has("period") else None
    require(period is None or period == knots[-1], "a periodic profile must end at its period")
    return Profile(knots, [table[i] for i in use], period)


def describe_profile(profile: Profile) -> str:
    """Return the schedule for people."""
    end = show(profile.knots[-1])
    kind_of = f"repeating every {end} s" if profile.period is not None else f"on [0, {end}] s, then 0"
    return f"the gain g(t) of the data, {len(profile.shapes)} polynomial pieces, {kind_of}"


# --- kind: persistent excitation -----------------------------------------------------------------


@kind("schedule-excitation")
def check_excitation(data: Node, certificate: Node) -> list[str]:
    """G is C1, and mu1 <= integral of g^2 over [t, t + T] <= mu2 with mu1 > 0, for every t >= 0.

    Of a finite table the claim speaks of the intervals within it.
    """
    profile, claim = read_profile(data), certificate["claim"]
    T, low, high = (claim[name].number() for name in ("length", "least", "greatest"))
    require(T > 0 and low > 0, "the length and the least integral must be positive")
    require_smooth(profile)
    end = profile.knots[-1]
    last = end if profile.period is not None else end - T
    require(last > 0, "the interval does not fit into the table")
    primitives = [_primitive(_times(shape, shape)) for shape in profile.shapes]
    lengths = [b - a for a, b in pairwise(profile.knots)]
    sums = [Fraction(0)]
    for q, h in zip(primitives, lengths, strict=True):
        sums.append(sums[-1] + h * sum(q))
    moved = {(knot - T) % end if profile.period is not None else knot - T for knot in profile.knots}
    instants = sorted({t for t in {*profile.knots, *moved, Fraction(0), last} if 0 <= t <= last})
    for a, b in pairwise(instants):
        ends = _along(profile, primitives, sums, a + T, b + T), _along(profile, primitives, sums, a, b)
        size = max(map(len, ends))
        upper, lower = (p + [Fraction(0)] * (size - len(p)) for p in ends)
        moving = [x - y for x, y in zip(upper, lower, strict=True)]
        require(
            _within(moving, low, high, 40),
            f"the integral leaves [mu1, mu2] for t in [{show(a)}, {show(b)}] s",
        )
    where = "for every t >= 0" if profile.period is not None else f"for 0 <= t <= {show(last)} s"
    return [
        f"g is C1 and {show(low)} s <= integral of g^2 over [t, t + {show(T)} s] <= {show(high)} s {where},",
        f"{describe_profile(profile)}",
    ]


# --- kinds: facts of a schedule --------------------------------------------------------------------
#
# A window is an interval [on, off] in which full thrust is certain. All comparisons are of rationals.

Span = tuple[Fraction, Fraction]


def read_windows(data: Node, profile: Profile) -> list[Span]:
    """Read the thruster windows of the table, or of one period, as the file lists them."""
    rows = data["windows"].matrix(columns=2)
    require(bool(rows), "there is no window")
    windows = [(on, off) for on, off in rows]
    within = profile.period is None or all(off <= profile.period for _, off in windows)
    require(all(on >= 0 for on, _ in windows) and within, "a window lies outside the period")
    return windows


def following(windows: list[Span], profile: Profile) -> list[Fraction]:
    """Gap after each window; the last one's up to the first window of the next period, if there is one."""
    gaps = [after[0] - before[1] for before, after in pairwise(windows)]
    if profile.period is not None:
        gaps.append(windows[0][0] + profile.period - windows[-1][1])
    return gaps


@kind("schedule-order")
def check_order(data: Node, certificate: Node) -> list[str]:
    """Windows are not empty, in order of time and disjoint, from one period to the next as well."""
    profile, claim = read_profile(data), certificate["claim"]
    windows = read_windows(data, profile)
    length = claim["shortest_window"].number()
    require(length > 0, "the shortest window must be longer than nothing")
    require(all(off - on >= length for on, off in windows), "a window is shorter than claimed")
    text = f"{describe_windows(windows, profile)}: in order, each at least {show(length)} s long,"
    gaps = following(windows, profile)
    if not gaps:
        return [text, "and there is only one"]
    least = claim["shortest_gap"].number()
    require(least >= 0, "a negative gap is an overlap")
    require(all(gap >= least for gap in gaps), "two windows are closer to each other than claimed")
    return [text, f"at least {show(least)} s from one to the next: disjoint"]


@kind("schedule-smooth")
def check_smooth(data: Node, certificate: Node) -> list[str]:
    """G and dg/dt are continuous at every knot, from one period to the next and at a table's end."""
    del certificate
    profile = read_profile(data)
    require_smooth(profile)
    return [f"g is C1: value and slope agree at every knot, for {describe_profile(profile)}"]


@kind("schedule-support")
def check_support(data: Node, certificate: Node) -> list[str]:
    """G = 0 outside the windows: every piece that is not the zero polynomial lies within one."""
    del certificate
    profile = read_profile(data)
    windows, joined = read_windows(data, profile), list[list[Fraction]]()
    for on, off in sorted(windows):
        if joined and on <= joined[-1][1]:
            joined[-1][1] = max(joined[-1][1], off)
        else:
            joined.append([on, off])
    openings = [on for on, _ in joined]
    for a, b in acting(profile):
        i = bisect_right(openings, a) - 1
        require(i >= 0 and b <= joined[i][1], f"g acts on [{show(a)}, {show(b)}] s, not within a window")
    return [f"g(t) = 0 outside {describe_windows(windows, profile)}, for {describe_profile(profile)}"]


@kind("schedule-uncertain-thrust")
def check_uncertain_thrust(data: Node, certificate: Node) -> list[str]:
    """G = 0 for the thruster's rise before every window and for its fall after it."""
    del certificate
    profile = read_profile(data)
    windows = read_windows(data, profile)
    rise, fall, spans = uncertain_spans(data, windows, profile)
    pieces = acting(profile)
    stops = [b for _, b in pieces]
    for on, off in spans:
        i = bisect_right(stops, on)
        met = i < len(pieces) and pieces[i][0] < off
        require(not met, f"g acts within [{show(on)}, {show(off)}] s, where the thrust is uncertain")
    return [
        f"g(t) = 0 for {show(rise)} s before and {show(fall)} s after {describe_windows(windows, profile)},",
        f"for {describe_profile(profile)}",
    ]


def acting(profile: Profile) -> list[Span]:
    """Pieces on which g is not the zero polynomial, in order of time."""
    pieces = zip(profile.shapes, pairwise(profile.knots), strict=True)
    return [(a, b) for shape, (a, b) in pieces if any(shape)]


def uncertain_spans(
    data: Node, windows: list[Span], profile: Profile
) -> tuple[Fraction, Fraction, list[Span]]:
    """Return rise, fall, and the intervals of [0, end] in which the thruster does either, in order.

    A window of a neighbouring period counts too.
    """
    rise, fall = (data["thruster"][name].number() for name in ("rise", "fall"))
    require(rise >= 0 and fall >= 0, "rise and fall must not be negative")
    end = profile.knots[-1]
    spans = [(on - rise, on) for on, _ in windows] + [(off, off + fall) for _, off in windows]
    shifts = (-end, Fraction(0), end) if profile.period is not None else (Fraction(0),)
    cut = [(max(a + shift, Fraction(0)), min(b + shift, end)) for a, b in spans for shift in shifts]
    return rise, fall, sorted((a, b) for a, b in cut if a < b)


def describe_windows(windows: list[Span], profile: Profile) -> str:
    """Return the windows for people."""
    first = f"[{show(windows[0][0])}, {show(windows[0][1])}] s"
    named = f"the window {first}" if len(windows) == 1 else f"the {len(windows)} windows from {first} on"
    return named + (f", every {show(profile.period)} s" if profile.period is not None else "")


@kind("schedule-counterexample")
def check_schedule_counterexample(data: Node, certificate: Node) -> list[str]:
    """One of the facts above is false, at the instant that the claim names."""
    profile, claim = read_profile(data), certificate["claim"]
    fact, t = claim["fact"].text(), claim["instant"].number()
    require(0 <= t <= profile.knots[-1], "the instant lies outside the table")
    if fact == "smooth":
        require(t > 0 or profile.period is not None, "a table begins at 0 s: there is nothing before it")
        sides = [profile.side(t, after=False), profile.side(t, after=True)]
        require(sides[0] != sides[1], "g and its slope are continuous there")
        values = " against ".join(f"g = {show(g)}, g' = {show(slope)} 1/s" for g, slope in sides)
        return [f"g is not C1: at t = {show(t)} s {values} after it, for {describe_profile(profile)}"]
    windows, g = read_windows(data, profile), profile.side(t, after=True)[0]
    require(g != 0, "g is zero there")
    where = describe_windows(windows, profile)
    if fact == "support":
        shifts = (0,) if profile.period is None else (-profile.period, 0, profile.period)
        closed = not any(on <= t + shift <= off for on, off in windows for shift in shifts)
        require(closed, "a window is open there")
        where = f"outside {where}"
    else:
        require(fact == "uncertain-thrust", f"there is no fact {fact!r}")
        rise, fall, spans = uncertain_spans(data, windows, profile)
        require(any(a < t < b for a, b in spans), "the thruster neither rises nor falls there")
        where = f"while the thruster rises ({show(rise)} s) or falls ({show(fall)} s) about {where}"
    return [f"g({show(t)} s) = {show(g)}, not zero, {where}, for {describe_profile(profile)}"]


# --- kinds: start of the filter --------------------------------------------------------------------


@kind("filter-start")
def check_filter_start(data: Node, certificate: Node) -> list[str]:
    """0 < R(0) <= 2 max g^2/lambda, at an instant that shows it, and R stays below a ceiling."""
    profile, R0, lam, greatest = _filter_start(data, certificate)
    t = certificate["witness"]["instant"].number()
    require(0 <= t <= profile.knots[-1], "the instant lies outside the table")
    g = profile.side(t, after=True)[0]
    require(lam * R0 <= 2 * g * g, "R(0) is not seen to be within the bound at that instant")
    return [
        f"0 < R(0) = {show(R0)} s <= 2 max g^2/lambda, lambda = {show(lam)} 1/s: g({show(t)} s) = {show(g)};",
        f"while R' = -lambda R + g^2 (1 + b0), R <= {show(max(R0, 2 * greatest**2 / lam))} s for ever,",
        f"for {describe_profile(profile)}",
    ]


@kind("filter-start-counterexample")
def check_filter_start_counterexample(data: Node, certificate: Node) -> list[str]:
    """R(0) > 2 max g^2/lambda."""
    profile, R0, lam, greatest = _filter_start(data, certificate)
    require(lam * R0 > 2 * greatest**2, "R(0) is not above the bound")
    return [
        f"R(0) = {show(R0)} s > 2 max g^2/lambda, lambda = {show(lam)} 1/s: g <= {show(greatest)},",
        f"for {describe_profile(profile)}",
    ]


def _filter_start(data: Node, certificate: Node) -> tuple[Profile, Fraction, Fraction, Fraction]:
    """Return the profile, R(0), lambda, and the bound on g that the claim names, proved."""
    profile = read_profile(data)
    R0, lam = (data["parameters"][name].number() for name in ("R0", "lambda"))
    greatest = certificate["claim"]["greatest"].number()
    require(R0 > 0 and lam > 0 and greatest >= 0, "R(0) and lambda must be positive")
    for shape in {tuple(shape) for shape in profile.shapes}:
        room = Form.constant(greatest) - from_powers(list(shape) or [Fraction(0)])
        require(room.is_nonnegative(40), "g is not proved to stay below the bound claimed")
    return profile, R0, lam, greatest


def require_smooth(profile: Profile) -> None:
    """Raise Invalid unless value and slope of g agree at every knot (and from zero to zero at the ends)."""
    zero = (Fraction(0), Fraction(0))
    first, last = [], []
    for shape, (a, b) in zip(profile.shapes, pairwise(profile.knots), strict=True):
        slope = [i * c / (b - a) for i, c in enumerate(shape)][1:]
        first.append((shape[0] if shape else Fraction(0), slope[0] if slope else Fraction(0)))
        last.append((sum(shape, Fraction(0)), sum(slope, Fraction(0))))
    wrap = first[0] if profile.period is not None else zero
    for left, right in zip(last, [*first[1:], wrap], strict=True):
        require(left == right, "g is not C1 at a knot")


def _times(p: Vector, q: Vector) -> Vector:
    result = [Fraction(0)] * max(len(p) + len(q) - 1, 0)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result


def _primitive(p: Vector) -> Vector:
    return [Fraction(0), *(c / (i + 1) for i, c in enumerate(p))]


def _compose(p: Vector, shift: Fraction, slope: Fraction) -> Vector:
    """Return u -> p(shift + slope u), highest powers last."""
    result: Vector = [Fraction(0)]
    for c in reversed(p):
        result = _times_affine(result, shift, slope)
        result[0] += c
    return result


def _along(profile: Profile, primitives: list[Vector], sums: Vector, a: Fraction, b: Fraction) -> Vector:
    """Return the integral of g^2 from 0 to t, as a polynomial of u, where t = a + (b - a) u in one piece."""
    end, cycles = profile.knots[-1], Fraction(0)
    if profile.period is not None:
        cycles = Fraction(a // end)
        a, b = a - cycles * end, b - cycles * end
    i = min(bisect_right(profile.knots, a) - 1, len(primitives) - 1)
    start, stop = profile.knots[i], profile.knots[i + 1]
    require(start <= a and b <= stop, "an interval crosses a knot of the schedule")
    h = stop - start
    local = [h * c for c in _compose(primitives[i], (a - start) / h, (b - a) / h)]
    local[0] += cycles * sums[-1] + sums[i]
    return local


def _within(p: Vector, low: Fraction, high: Fraction, depth: int) -> bool:
    """Whether low <= p <= high on [0, 1], by Bernstein coefficients of ever smaller halves."""
    n = len(p) - 1
    controls = [
        sum((Fraction(comb(i, j), comb(n, j)) * p[j] for j in range(i + 1)), Fraction(0))
        for i in range(n + 1)
    ]
    if all(low <= c <= high for c in controls):
        return True
    if depth == 0 or not (low <= controls[0] <= high and low <= controls[-1] <= high):
        return False
    half = Fraction(1, 2)
    return all(_within(_compose(p, shift, half), low, high, depth - 1) for shift in (Fraction(0), half))


# --- kind: floor of the filter state ---------------------------------------------------------------
#
# Variables: S = 1 - b0, s = sqrt(S), y = |Omega|_J, Omega = w + 2 g^2 kappa bv. Along the closed loop
#   y' = -(1/2) g^2 kappa (2 - S) y,    |s' + (1/2) g^2 kappa s (2 - S)| <= c A(S) y,
#   R' = -lambda R + g^2 (2 - S),       k' = gamma R g^2 (2 - S)(y^2 + 2 a S),
# A(S) = 1 - S/4 - S^2/32 >= sqrt(1 - S/2), c >= 1/sqrt(8 Jmin). A bound whose slope is on its safe
# side wherever the component touches it, the others within their bounds, is never crossed.

LOOPS = {  # these two laws are known by their equations: see `compared_law`
    "persistence-filter": "kappa = 1/R",
    "adaptive-scaling": "kappa = k, k' = gamma R g^2 [(1 + b0) Omega'J Omega + 2 a |bv|^2]",
}


@dataclass(frozen=True)
class FloorData:
    """What the steps of a witness are checked against."""

    law: str
    lam: Fraction
    R0: Fraction
    gamma: Fraction
    k0: Fraction
    a: Fraction
    c: Fraction
    greatest: Fraction
    profile: Profile


@dataclass(frozen=True)
class FloorStep:
    """One step: its interval, the forms used, and the polynomial of each component."""

    start: Fraction
    stop: Fraction
    modes: list[str]
    x: dict[str, Form]
    ends: dict[str, tuple[Fraction, Fraction]]


Bounds = dict[str, Fraction]


MAX_EXPONENT = 4096
MAX_COUNT = 64
"""Of a polynomial's power of 2, and of its coefficients: beyond, checking would take for ever."""


def components(law: str, *, tail: bool) -> dict[str, int]:
    """Components with their side: -1 a lower bound, +1 an upper one."""
    if law == "persistence-filter":
        return {"K": -1, "y": 1, "s": 1, "v": 1, "z": 1, "r": -1}
    if tail:
        return {"k": -1, "r": -1, "Y": 1, "Z": 1, "L": 1, "U": 1}
    return {"y": -1, "s": -1, "k": -1, "r": -1, "Y": 1, "Z": 1, "L": 1, "U": 1}


def read_steps(place: Node, start: Fraction, sides: dict[str, int]) -> list[FloorStep]:
    """Read steps that follow each other from `start`, every bound jumping to its loose side only."""
    steps: list[FloorStep] = []
    for node in place.items():
        stop = node["until"].number()
        require(stop > start, f"{node.path}: a step must end after it begins")
        x, ends = {}, {}
        for name in sides:
            numbers = node["bounds"][name].vector()
            require(all(v.denominator == 1 for v in numbers), f"{node.path}: expected integers for {name}")
            exponent, *mantissas = (int(v) for v in numbers)
            require(
                abs(exponent) <= MAX_EXPONENT and 0 < len(mantissas) <= MAX_COUNT,
                f"{node.path}: the polynomial of {name} is out of range",
            )
            unit = Fraction(2) ** exponent
            x[name] = Form.of([m * unit for m in mantissas])
            ends[name] = (mantissas[0] * unit, mantissas[-1] * unit)
        modes = [mode.text() for mode in node["forms"].items()]
        steps.append(FloorStep(start, stop, modes, x, ends))
        if len(steps) > 1:
            require_loose(sides, {n: e[1] for n, e in steps[-2].ends.items()}, steps[-1], node.path)
        start = stop
    require(bool(steps), f"{place.path}: there are no steps")
    return steps


def require_loose(sides: dict[str, int], before: Bounds, step: FloorStep, path: str) -> None:
    """Check that a step begins no tighter than what is known."""
    for name, side in sides.items():
        if name in before:
            gap = side * (step.ends[name][0] - before[name])
            require(gap >= 0, f"{path}: the bound {name} begins tighter than is known")


def check_step(d: FloorData, step: FloorStep, *, tail: bool) -> None:
    """Check every differential inequality on a step."""
    g = d.profile.gain(step.start, step.stop)
    G = g * g
    per_second = 1 / (step.stop - step.start)
    dx = {name: p.derivative().times(per_second) for name, p in step.x.items()}
    if d.law == "persistence-filter":
        conditions = persistence_conditions(d, G, step.x, dx, step.modes, tail=tail)
    elif tail:
        conditions = adaptive_tail_conditions(d, G, step.x, dx)
    else:
        conditions = adaptive_conditions(d, G, step.x, dx, step.modes)
    for name, condition in conditions:
        where = f"on [{show(step.start)}, {show(step.stop)}] s"
        require(condition.is_nonnegative(), f"{name} is not proved {where}")


Conditions = Iterator[tuple[str, Form]]
ONE, TWO = Form.constant(1), Form.constant(2)
NO_BOUND = Fraction(3, 2)


def angle_factor(S: Form) -> Form:
    """A(S) = 1 - S/4 - S^2/32."""
    return ONE - S.times(Fraction(1, 4)) - (S * S).times(Fraction(1, 32))


def persistence_conditions(
    d: FloorData, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: list[str], *, tail: bool
) -> Conditions:
    """K <= 1/R; y, s; v, z with S <= R0 z^2/R; and the floor r.

    In v = y sqrt(R/R0), z = s sqrt(R/R0): v' = -(lambda/2) v, z' <= -(lambda/2) z + c v (1 - S/4).
    """
    K, y, s, v, z, r = (x[name] for name in ("K", "y", "s", "v", "z", "r"))
    require(len(modes) == 2 and modes[0] in ("angle", "blind"), "unknown form of the inequalities")
    yield "K >= 0", K
    yield "slope of K", K.times(d.lam) - (G * K * K).times(2) - dx["K"]
    if modes[0] == "angle":
        S = s * s
        pull = (G * K * (TWO - S)).times(HALF)
        yield "s^2 <= 2", TWO - S
        yield "s >= 0", s
        yield "slope of y", dx["y"] + pull * y
        drift = y if tail else y * angle_factor(S)
        yield "slope of s", dx["s"] - drift.times(d.c) + pull * s
    else:
        yield "slope of y", dx["y"]
        yield "s above sqrt 2", s - Form.constant(NO_BOUND)
    yield "v >= 0", v
    yield "y >= 0", y
    yield "slope of v", dx["v"] + v.times(d.lam / 2)
    bend = ONE if tail else ONE - (K * z * z).times(d.R0 / 4)
    yield "slope of z", dx["z"] + z.times(d.lam / 2) - (v * bend).times(d.c)
    yield "z >= 0", z
    yield "r >= 0", r
    if modes[1] == "none":
        yield "slope of r", -dx["r"] - r.times(d.lam)
    elif modes[1] == "angle":
        require(modes[0] == "angle", "the angle is not bounded on this step")
        yield "slope of r", G * (TWO - s * s) - r.times(d.lam) - dx["r"]
    else:
        require(modes[1] == "cascade", "unknown form of the inequalities")
        require(min(x["r"].plain()[0]) > 0, "the floor is not positive")
        yield "slope of r", G * (r.times(2) - (z * z).times(d.R0)) - r * (r.times(d.lam) + dx["r"])


def adaptive_conditions(
    d: FloorData, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: list[str]
) -> Conditions:
    """Lower bounds y, s, k, r and upper bounds Y, Z, L, U of |Omega|_J, sqrt(S), k, R."""
    y, s, k, r = (x[name] for name in ("y", "s", "k", "r"))
    Y, Z, L, U = (x[name] for name in ("Y", "Z", "L", "U"))
    require(len(modes) == 2 and modes[0] in ("kept", "zero"), "unknown form of the inequalities")
    S, T = s * s, Z * Z
    low_room, high_room = TWO - S, TWO - T
    yield "s^2 <= 2", high_room
    yield from ((f"{name} >= 0", x[name]) for name in x)
    low_pull, high_pull = (G * L * low_room).times(HALF), (G * k * high_room).times(HALF)
    yield "slope of y", -dx["y"] - low_pull * y
    yield "slope of Y", dx["Y"] + high_pull * Y
    if modes[0] == "kept":
        yield "slope of s", -dx["s"] - (Y * angle_factor(S)).times(d.c) - low_pull * s
    else:
        yield "s = 0", -s
    yield "slope of Z", dx["Z"] - (Y * angle_factor(T)).times(d.c) + high_pull * Z
    yield "slope of r", G * high_room - r.times(d.lam) - dx["r"]
    yield "slope of U", dx["U"] + U.times(d.lam) - G * low_room
    for room, square in ((low_room, S), (high_room, T)):
        yield "slope of k", (G * r * room * (y * y + square.times(2 * d.a))).times(d.gamma) - dx["k"]
    a, square = d.a, Y * Y
    if modes[1] == "top":
        crest = ONE + square.times(1 / (4 * a))
        f = (crest * crest).times(2 * a)
    elif modes[1] == "rising":
        f = high_room * (square + T.times(2 * a))
        yield "f rises up to s", Form.constant(4 * a) - square - T.times(4 * a)
    elif modes[1] == "falling":
        f = low_room * (square + S.times(2 * a))
        yield "f falls from s on", square + S.times(4 * a) - Form.constant(4 * a)
    else:
        require(modes[1] == "split", "unknown form of the inequalities")
        f = low_room * (square + T.times(2 * a))
    yield "slope of L", dx["L"] - (G * U * f).times(d.gamma)


def adaptive_tail_conditions(d: FloorData, G: Form, x: dict[str, Form], dx: dict[str, Form]) -> Conditions:
    """Repeating part: k held, (Y, Z) may be scaled down together, L grows by what (Y, Z) feed it."""
    k, r, Y, Z, U = (x[name] for name in ("k", "r", "Y", "Z", "U"))
    T = Z * Z
    room = TWO - T
    pull = (G * k * room).times(HALF)
    yield "s^2 <= 2", room
    yield from ((f"{name} >= 0", x[name]) for name in x)
    yield "slope of k", -dx["k"]
    yield "slope of r", G * room - r.times(d.lam) - dx["r"]
    yield "slope of Y", dx["Y"] + pull * Y
    yield "slope of Z", dx["Z"] - Y.times(d.c) + pull * Z
    yield "slope of U", dx["U"] + U.times(d.lam) - G.times(2)
    yield "slope of L", dx["L"] - (G * U * (Y * Y + T.times(2 * d.a))).times(2 * d.gamma)


def read_floor_data(data: Node, witness: Node) -> FloorData:
    """Read the loop's data; check c >= 1/sqrt(8 Jmin) and greatest >= Jmax for every inertia."""
    law = read_compared(data)
    names = {"R": "R0", "k": "k0"} if law.gain == "adaptive-scaling" else {"R": "R0"}
    if data.has("initial"):
        require(set(data["initial"].keys()) == set(names), "expected the initial value of every state")
        start = {name: data["initial"][name].number() for name in names}
    else:  # files of earlier versions give them among the parameters
        start = {name: data["parameters"][old].number() for name, old in names.items()}
    require(start["R"] > 0 and start.get("k", Fraction(0)) >= 0, "expected R(0) > 0 and k(0) >= 0")
    c, greatest = witness["coupling"].number(), witness["greatest_inertia"].number()
    require(c > 0, "the coupling must be positive")
    for J in inertia_vertices(data):  # convex in J: the vertices suffice
        gap = [[8 * c * c * J[i][j] - (1 if i == j else 0) for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "the coupling is below 1/sqrt(8 Jmin)")
        gap = [[(greatest if i == j else 0) - J[i][j] for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "the greatest inertia is too small")
    profile = read_profile(data)
    require_continuous(profile)
    k0 = start.get("k", Fraction(0))
    return FloorData(law.gain, law.lam, start["R"], law.gamma, k0, law.a, c, greatest, profile)


def read_compared(data: Node) -> Compared:
    """Return the law of the data: its program, or in files of earlier versions the equations by a name.

    Such a file holds no program: its claim is about the equations that are printed with it.
    """
    if data["law"].has("program"):
        return compared_law(data)
    law = data["law"]["name"].text()
    require(law in LOOPS, f"no comparison system is known for the law {law!r}")
    names = ("lambda", "gamma", "a") if law == "adaptive-scaling" else ("lambda",)
    values = {name: data["parameters"][name].number() for name in names}
    require(all(v > 0 for v in values.values()), "parameters must be positive")
    zero = Fraction(0)
    return Compared(law, values["lambda"], values.get("gamma", zero), values.get("a", zero))


def require_continuous(profile: Profile) -> None:
    """Check that g does not jump: the laws use g', and Omega would jump with g."""
    starts = [shape[0] if shape else Fraction(0) for shape in profile.shapes]
    ends = [sum(shape, Fraction(0)) for shape in profile.shapes]
    following = [*starts[1:], Fraction(0) if profile.period is None else starts[0]]
    require(ends == following, "the gain jumps at a knot")


PI_HIGH = Fraction(31415926535897932384626433832795028842, 10**37)
"""Above pi, by less than 1e-37."""


def cosine_below(degrees: Fraction) -> Fraction:
    """Return a rational <= cos(degrees), 0 <= degrees <= 180, by an alternating series cut while it falls."""
    x = degrees * PI_HIGH / 180
    term, total_, k = Fraction(1), Fraction(1), 0
    while k % 2 == 0 or abs(term) > Fraction(1, 10**40):
        k += 1
        term = -term * x * x / ((2 * k - 1) * (2 * k))
        total_ += term
    return total_


def check_initial_set(data: Node, d: FloorData, witness: Node) -> str:
    """Check that the witness's box [0, s] x [0, y] holds the initial set; return the set for people."""
    node, box = data["initial_set"], witness["box"]
    s, y = box["s"].number(), box["y"].number()
    angle = node["max_angle_deg"].number()
    require(0 <= angle <= 360 and s >= 0 and y >= 0, "the initial set is not one")
    require(s * s >= 2 or angle == 0 or s * s >= 1 - cosine_below(angle / 2), "s is too small for the angle")
    words = [f"2 acos(b0) <= {show(angle)} deg"]
    enough = False
    if node.has("max_weighted_rate"):
        weighted = node["max_weighted_rate"].number()
        require(weighted >= 0, "a bound of the rate must not be negative")
        words.append(f"sqrt(Omega'J Omega) <= {show(weighted)}")
        enough = y >= weighted
    if node.has("max_rate") or not node.has("max_weighted_rate"):
        rate = node["max_rate"].number() if node.has("max_rate") else Fraction(0)
        require(rate >= 0, "a bound of the rate must not be negative")
        words.append(f"|w| <= {show(rate)} rad/s" if node.has("max_rate") else "at rest")
        g = d.profile.shapes[0][0] if d.profile.shapes[0] else Fraction(0)
        kappa = 1 / d.R0 if d.law == "persistence-filter" else d.k0
        reach = abs(rate) + 2 * g * g * kappa * min(Fraction(1), s * NO_BOUND)  # |bv| <= s sqrt 2
        enough = enough or y * y >= d.greatest * reach * reach
    require(enough, "y is too small for the rates of the set")
    return ", ".join(words)


def require_cover(bins: list[tuple[Vector, Vector]], s: Fraction, y: Fraction) -> None:
    """Check that rectangles cover [0, s] x [0, y]."""
    s_edges = sorted({Fraction(0), s, *(e for b, _ in bins for e in b if 0 < e < s)})
    y_edges = sorted({Fraction(0), y, *(e for _, b in bins for e in b if 0 < e < y)})
    for a, b in list(pairwise(s_edges)) or [(s, s)]:
        for c, e in list(pairwise(y_edges)) or [(y, y)]:
            held = any(p[0] <= a and b <= p[1] and q[0] <= c and e <= q[1] for p, q in bins)
            require(held, f"no bin holds s in [{show(a)}, {show(b)}], y in [{show(c)}, {show(e)}]")


@dataclass(frozen=True)
class FloorBin:
    """One bin's proved witness."""

    steps: list[FloorStep]
    tail: list[FloorStep]
    ratio: Fraction
    ends: Bounds


def check_bin(d: FloorData, place: Node, s: Vector, y: Vector) -> FloorBin:
    """Check one bin: its start, its steps, and its repeating part if it has one."""
    sides = components(d.law, tail=False)
    steps = read_steps(place["steps"], Fraction(0), sides)
    if d.law == "persistence-filter":
        known = {"K": 1 / d.R0, "r": d.R0, "y": y[1], "v": y[1], "s": s[1], "z": s[1]}
    else:
        known = {"k": d.k0, "L": d.k0, "r": d.R0, "U": d.R0, "y": y[0], "Y": y[1], "s": s[0], "Z": s[1]}
    require_loose(sides, known, steps[0], place.path)
    for step in steps:
        check_step(d, step, tail=False)
    ends = {name: pair[1] for name, pair in steps[-1].ends.items()}
    if not place.has("tail"):
        return FloorBin(steps, [], Fraction(1), ends)
    tail, ratio = check_tail(d, place["tail"], steps[-1].stop, ends)
    return FloorBin(steps, tail, ratio, ends)


def is_blind(step: FloorStep) -> bool:
    """Whether a step gives up the bounds y and s: v and z alone bound rate and angle."""
    return step.modes[:1] == ["blind"]


def check_tail(d: FloorData, place: Node, start: Fraction, known: Bounds) -> tuple[list[FloorStep], Fraction]:
    """Check a part that repeats for ever: lower bounds end no lower, upper bounds no higher than they began.

    Those of angle and rate end at most `ratio` times where they began.
    """
    period, ratio = d.profile.period, place["ratio"].number()
    require(period is not None, "a finite schedule has no repeating part")
    assert period is not None
    require(start % period == 0, "the repeating part must begin at a whole period")
    require(0 <= ratio < 1, "the ratio must lie in [0, 1)")
    sides = components(d.law, tail=True)
    steps = read_steps(place["steps"], start, sides)
    require(steps[-1].stop == start + period, "the repeating part must cover one period")
    require_loose(sides, known, steps[0], place.path)
    for step in steps:
        check_step(d, step, tail=True)
    blind = is_blind(steps[0])
    require(all(is_blind(step) == blind for step in steps), "the angle is bounded on a part of a period only")
    decaying = {"y", "s", "v", "z", "Y", "Z"} - ({"y", "s"} if blind else set())
    for name, side in sides.items():
        first, last = steps[0].ends[name][0], steps[-1].ends[name][1]
        if name in decaying:
            require(last <= ratio * first, f"{place.path}: {name} does not shrink by the ratio")
        elif name not in ("L", "y", "s"):
            require(side * (first - last) >= 0, f"{place.path}: {name} does not come back to where it began")
    return steps, ratio


@kind("filter-floor")
def check_filter_floor(data: Node, certificate: Node) -> list[str]:
    """R >= floor from every start of a set, for all time or up to a horizon; and convergence."""
    claim, witness = certificate["claim"], certificate["witness"]
    d = read_floor_data(data, witness)
    words = check_initial_set(data, d, witness)
    places = witness["bins"].items()
    rectangles = [(p["s"].vector(2), p["y"].vector(2)) for p in places]
    require_cover(rectangles, witness["box"]["s"].number(), witness["box"]["y"].number())
    bins = [check_bin(d, p, s, y) for p, (s, y) in zip(places, rectangles, strict=True)]
    floor = claim["floor"].number()
    require(floor > 0, "the floor must be positive")
    for proved in bins:
        for step in (*proved.steps, *proved.tail):
            require(step.x["r"].is_at_least(floor), f"r falls below the floor after {show(step.start)} s")
    if claim.has("horizon"):
        horizon = claim["horizon"].number()
        require(horizon > 0, "the horizon must be positive")
        reached = all(b.tail or b.steps[-1].stop >= horizon for b in bins)
        require(reached, "a bin ends before the horizon")
        when = f"on [0, {show(horizon)}] s"
    else:
        require(all(b.tail for b in bins), "a bin has no repeating part: no claim for all time")
        when = "for all t >= 0"
    adaptive = d.law == "adaptive-scaling"
    start = f", k(0) = {show(d.k0)} 1/s" if adaptive else ""
    gains = f", gamma = {show(d.gamma)}, a = {show(d.a)}" if adaptive else ""
    lines = [
        f"R(t) >= {show(floor)} s {when},",
        f"from every start with {words}, R(0) = {show(d.R0)} s{start},",
        f"R' = -lambda R + g^2 (1 + b0), lambda = {show(d.lam)} 1/s,",
        f"law {d.law}: Omega = w + 2 g^2 kappa bv, {LOOPS[d.law]}{gains},",
        "whose torque gives J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega,",
        f"{describe_profile(d.profile)},",
        describe_inertia(data),
    ]
    lines += check_convergence(claim, bins, d)
    if claim.has("settling") or claim.has("torque"):
        covered = [all_boxes(d, proved) for proved in bins]
        lines += check_settling(claim, bins, covered, d) + check_torque(claim, covered, d)
    return lines


def check_convergence(claim: Node, bins: list[FloorBin], d: FloorData) -> list[str]:
    """Check that sqrt(1 - b0) and |Omega|_J shrink by the claimed ratio per period, if that is claimed."""
    if not claim.has("ratio"):
        return []
    ratio, start = claim["ratio"].number(), claim["ratio_from"].number()
    require(ratio < 1, "the ratio must be below 1")
    shrinks = all(b.tail and b.ratio <= ratio and b.tail[0].start <= start for b in bins)
    require(shrinks, "a bin does not shrink by the ratio")
    assert d.profile.period is not None
    return [
        f"and the bounds of sqrt(1 - b0) and |Omega|_J shrink by a factor {show(ratio)} every "
        f"{show(d.profile.period)} s from t = {show(start)} s on: attitude and rate converge"
    ]


def root_above(value: Fraction) -> Fraction:
    """Return a rational >= sqrt(value), within a part in 2^60 of it."""
    if value <= 0:
        return Fraction(0)
    shift = max(0, 120 - value.numerator.bit_length() + value.denominator.bit_length())
    shift += shift % 2
    return Fraction(isqrt((value.numerator << shift) // value.denominator + 1) + 1, 1 << shift // 2)


@dataclass(frozen=True)
class Box:
    """Bounds that hold throughout an eighth of a step.

    `S` and `y` from above; `R` from above; kappa in [low, high]; |g| <= `g`; g' in `slope`.
    """

    stop: Fraction
    S: Fraction
    y: Fraction
    R: Fraction
    low: Fraction
    high: Fraction
    g: Fraction
    slope: tuple[Fraction, Fraction]

    @property
    def bv(self) -> Fraction:
        """Bound of |bv| = sqrt(S' (2 - S')) over S' <= S."""
        inside = min(self.S, Fraction(1))
        return root_above(inside * (2 - inside))


def eighths(p: Form) -> list[tuple[Fraction, Fraction]]:
    """Bounds of a polynomial on the eight equal parts of [0, 1]."""
    controls, scale = p.plain()
    parts = [controls]
    for _ in range(3):
        parts = [half for part in parts for half in halves(part)]
    unit = scale << 3 * (len(controls) - 1)
    return [(Fraction(min(part), unit), Fraction(max(part), unit)) for part in parts]


def boxes(d: FloorData, step: FloorStep, *, repeats: bool, limit: Fraction | None = None) -> list[Box]:
    """Return the boxes of a step; `limit` bounds L over all later time, where the step repeats.

    Where it does, S and y are scaled down period by period: they must not rest on bounds that are not.
    """
    bounds = {name: eighths(p) for name, p in step.x.items()}
    length = (step.stop - step.start) / 8
    result = []
    for i in range(8):
        start = step.start + i * length
        low, high = ({name: pairs[i][side] for name, pairs in bounds.items()} for side in (0, 1))
        g = d.profile.gain(start, start + length)
        slope = [c / length for c in bernstein(g.derivative())]
        shared = (max(map(abs, bernstein(g))), (min(slope), max(slope)))
        if d.law == "persistence-filter":
            require(low["r"] > 0 and low["K"] > 0, "the floor is not positive")
            share = d.R0 / low["r"]
            S, y = high["z"] ** 2 * share, high["v"] * root_above(share)
            if not is_blind(step):
                S, y = min(S, high["s"] ** 2), min(y, high["y"])
            elif not repeats:
                S, y = min(S, Fraction(2)), min(y, high["y"])
            result.append(Box(start + length, S, y, 1 / low["K"], low["K"], 1 / low["r"], *shared))
        else:
            top = high["L"] if limit is None else limit
            result.append(Box(start + length, high["Z"] ** 2, high["Y"], high["U"], low["k"], top, *shared))
    return result


def bernstein(p: Form) -> Vector:
    """Return the Bernstein coefficients."""
    controls, scale = p.plain()
    return [Fraction(c, scale) for c in controls]


Boxes = tuple[list[Box], list[Box]]


def all_boxes(d: FloorData, proved: FloorBin) -> Boxes:
    """Boxes of a bin's transient, and of the first period of its repeating part."""
    transient = [box for step in proved.steps for box in boxes(d, step, repeats=False)]
    limit = None
    if proved.tail and "L" in proved.tail[0].ends:
        first, last = proved.tail[0].ends["L"][0], proved.tail[-1].ends["L"][1]
        limit = first + max(last - first, Fraction(0)) / (1 - proved.ratio**2)
    return transient, [box for step in proved.tail for box in boxes(d, step, repeats=True, limit=limit)]


def rate_above(d: FloorData, box: Box, bv: Fraction) -> Fraction:
    """Bound of |w| <= |Omega| + 2 g^2 kappa |bv|, with |Omega| <= y/sqrt(Jmin) <= sqrt(8) c y."""
    return root_above(8 * d.c * d.c * box.y * box.y) + 2 * box.g**2 * box.high * bv


def check_settling(claim: Node, bins: list[FloorBin], covered: list[Boxes], d: FloorData) -> list[str]:
    """Check that |bv| and |w| stay within tolerances from a time on, if that is claimed."""
    if not claim.has("settling"):
        return []
    node = claim["settling"]
    time, attitude, rate = (node[name].number() for name in ("time", "attitude", "rate"))
    for proved, (transient, repeated) in zip(bins, covered, strict=True):
        for box in transient:
            bv = box.bv
            within = bv <= attitude and rate_above(d, box, bv) <= rate
            require(box.stop <= time or within, f"not settled before {show(box.stop)} s")
        if not repeated:
            require(claim.has("horizon"), "a bin has no repeating part")
            continue
        period = d.profile.period
        assert period is not None
        n = max(int((time - proved.tail[0].start) // period), 0)
        require(n <= 10**5, "the settling time is out of range")
        for periods in (n, n + 1):
            scale = proved.ratio**periods
            for box in repeated:
                bv = root_above(2 * box.S)
                within = bv * scale <= attitude and rate_above(d, box, bv) * scale <= rate
                stop = box.stop + periods * period
                require(stop <= time or within, f"not settled before {show(stop)} s")
    end = f" up to {show(claim['horizon'].number())} s" if claim.has("horizon") else " for good"
    return [f"and |bv| <= {show(attitude)}, |w| <= {show(rate)} rad/s from t = {show(time)} s on{end}"]


def check_torque(claim: Node, covered: list[Boxes], d: FloorData) -> list[str]:
    """Check a bound of the Euclidean norm of the applied torque g u, if one is claimed.

    u = q J bv - 2 g kappa bv x J Omega + 4 g^3 kappa^2 bv x J bv - g kappa J (b0 Omega + bv x Omega)
        - (g/2) kappa (1 + b0) J Omega,   q = -4 g' kappa - 2 g kappa' + 2 g^3 kappa^2 b0.
    """
    if not claim.has("torque"):
        return []
    bound = claim["torque"].number()
    least, root = 1 / (8 * d.c * d.c), root_above(d.greatest)
    for transient, repeated in covered:
        for box in (*transient, *repeated):
            g, high, n = box.g, box.high, box.bv
            u = (
                max(abs(q) for q in torque_coefficient(d, box)) * d.greatest * n
                + 2 * g * high * n * root * box.y
                + 2 * g**3 * high**2 * (d.greatest - least) * n**2
                + g * high * d.greatest * root_above(box.y**2 / least)
                + g * high * root * box.y
            )
            require(g * u <= bound, f"the torque is not bounded before {show(box.stop)} s")
    return [f"and |g u| <= {show(bound)} N m (Euclidean)"]


def torque_coefficient(d: FloorData, box: Box) -> tuple[Fraction, Fraction]:
    """Bounds of q."""
    g, high, zero = box.g, box.high, Fraction(0)
    slope = [-4 * s * k for s in box.slope for k in (box.low, high)]
    b0, square = 1 - min(box.S, Fraction(2)), 2 * g**3 * high**2
    if d.law == "persistence-filter":  # kappa' = lambda kappa - g^2 kappa^2 (1 + b0)
        low = -2 * g * d.lam * high + min(square * (1 + 2 * b0), zero)
        return min(slope) + low, max(slope) + 3 * square
    y2 = box.y**2
    intake = min(2 * (y2 + 2 * d.a * box.S), 2 * d.a * (1 + y2 / (4 * d.a)) ** 2)
    low = -2 * g**3 * d.gamma * box.R * intake + min(square * b0, zero)
    return min(slope) + low, max(slope) + square


# --- kind: Floquet multipliers of a linear plant ---------------------------------------------------

TERMS = 30
GRID = 2**128
"""Entries are multiples of 1/GRID; what is rounded away enters the radius."""


def norm(A: Matrix) -> Fraction:
    """Largest row sum of absolute values."""
    return max(sum((abs(x) for x in row), Fraction(0)) for row in A)


def matrix_product(A: Matrix, B: Matrix) -> Matrix:
    """Return A B."""
    columns = list(zip(*B, strict=True))
    return [[sum((a * b for a, b in zip(row, c, strict=True)), Fraction(0)) for c in columns] for row in A]


Grid = list[list[int]]


def grid_product(A: Grid, B: Grid) -> Grid:
    """Return the product of two matrices of multiples of 1/GRID, rounded down: off by < 1/GRID an entry."""
    columns = list(zip(*B, strict=True))
    return [[sum(map(mul, row, column)) // GRID for column in columns] for row in A]


def monodromy(A: Matrix, F: Matrix, profile: Profile) -> tuple[Matrix, Fraction]:
    """Enclose the matrix that takes x(0) to x(T) for x' = (A - g(t) F) x: a centre and a radius.

    The radius bounds the largest row sum of the error. Each piece of g is cut so that the Taylor
    series of the transition matrix converges fast; its tail is bounded by a majorant.
    """
    n = len(A)
    centre = [[GRID * (i == j) for j in range(n)] for i in range(n)]
    radius = Fraction(0)
    for start, stop in pairwise(profile.knots):
        size = (stop - start) * (norm(A) + norm(F))
        count = 1
        require(size < 10**5, "a piece of the schedule is too long for its plant")
        while count < 2 * size:
            count *= 2
        for i in range(count):
            a, b = (start + (stop - start) * Fraction(j, count) for j in (i, i + 1))
            step, error = transition(A, F, profile.gain(a, b), b - a)
            radius = grid_norm(step) * radius + error * (grid_norm(centre) + radius) + Fraction(n, GRID)
            radius = Fraction(int(radius * GRID) + 1, GRID)
            centre = grid_product(step, centre)
    return [[Fraction(x, GRID) for x in row] for row in centre], radius


def grid_norm(A: Grid) -> Fraction:
    """Largest row sum of absolute values."""
    return Fraction(max(sum(map(abs, row)) for row in A), GRID)


def transition(A: Matrix, F: Matrix, gain: Form, h: Fraction) -> tuple[Grid, Fraction]:
    """Enclose the transition matrix over one step: Taylor terms X_k of X' = sum_j M_j x^j X, 0 <= x <= 1.

    (k + 1) X_{k+1} = sum_j M_j X_{k-j}, in multiples of 1/GRID. With m_j >= |M_j| the terms of
    exp(sum m_j x^(j+1)/(j+1)) dominate |X_k|; an error e put into one term, or into M, moves the
    sum by at most e exp(2 sum m_j); at x = 4 the same series bounds the tail left out.
    """
    n, powers = len(A), power_coefficients(gain)
    M: list[Grid] = []
    for j, g in enumerate(powers):
        exact_rows = [[(A[r][c] if j == 0 else 0) - g * F[r][c] for c in range(n)] for r in range(n)]
        M.append([[round(h * x * GRID) for x in row] for row in exact_rows])
    term = [[GRID * (i == j) for j in range(n)] for i in range(n)]
    terms, total_ = [term], term
    for k in range(TERMS):
        rows = [[0] * n for _ in range(n)]
        for j in range(min(k, len(M) - 1) + 1):
            columns = list(zip(*terms[k - j], strict=True))
            rows = [
                [x + sum(map(mul, row, column)) for x, column in zip(known, columns, strict=True)]
                for known, row in zip(rows, M[j], strict=True)
            ]
        term = [[x // (GRID * (k + 1)) for x in row] for row in rows]
        terms.append(term)
        total_ = [[x + y for x, y in zip(*pair, strict=True)] for pair in zip(total_, term, strict=True)]
    sizes = [grid_norm(m) + Fraction(n, GRID) for m in M]
    moved = 3 ** (int(2 * sum(sizes, Fraction(0))) + 1)
    reach = sum((m * Fraction(4) ** (j + 1) / (j + 1) for j, m in enumerate(sizes)), Fraction(0))
    error = Fraction(n * (TERMS + len(M)), GRID) * moved + Fraction(3 ** (int(reach) + 1), 4 ** (TERMS + 1))
    return total_, error


def power_coefficients(p: Form) -> Vector:
    """Return power coefficients of a polynomial on [0, 1], lowest first."""
    n = len(p.a) - 1
    result = [0] * (n + 1)
    for j, a in enumerate(p.a):
        for i in range(n - j + 1):
            result[j + i] += a * comb(n - j, i) * (-1) ** i
    return [Fraction(c, p.scale) for c in result]


@kind("floquet")
def check_floquet(data: Node, certificate: Node) -> list[str]:
    """Bound the spectral radius of a periodic linear plant's monodromy matrix M, on one side.

    Below r: P > 0 with M'PM < r^2 P. Above r: x'Px > 0 for some x, and M'PM > r^2 P, so that
    V = x'Px grows by more than r^2 a period. Both with room for the enclosure's radius.
    """
    plant, claim, witness = data["plant"], certificate["claim"], certificate["witness"]
    A, B, K = (plant[name].matrix() for name in ("A", "B", "K"))
    n = len(A)
    require(n <= MAX_COUNT, "the plant has too many states")
    fits = len(A[0]) == n and len(B) == n and len(K) == len(B[0]) and len(K[0]) == n
    require(fits, "A, B and K do not fit each other")
    profile = read_profile(data)
    require(profile.period is not None, "Floquet multipliers need a periodic schedule")
    M, radius = monodromy(A, matrix_product(B, K), profile)
    side, r = claim["side"].text(), claim["radius"].number()
    require_change(M, radius, side, r, witness)
    fate = " (stable)" if side == "below" and r <= 1 else " (unstable)" if side == "above" and r >= 1 else ""
    return [
        f"every Floquet multiplier is below {show(r)} in modulus{fate}"
        if side == "below"
        else f"some Floquet multiplier is above {show(r)} in modulus{fate}",
        f"for x' = (A - g(t) B K) x, A = {show_matrix(A)}, B = {show_matrix(B)}, K = {show_matrix(K)},",
        describe_profile(profile),
    ]


def require_change(M: Matrix, radius: Fraction, side: str, r: Fraction, witness: Node) -> None:
    """Check that V = x'Px falls below r^2 V, or grows above it, from x to M x, M known to `radius`."""
    n, P = len(M), witness["P"].matrix(len(M), len(M))
    require(is_symmetric(P), "P is not symmetric")
    require(side in ("below", "above") and r > 0, "a spectral radius lies below or above a positive number")
    error = n * radius
    room = (2 * n * norm(M) * error + error**2) * norm(P)
    grown = matrix_product([list(c) for c in zip(*M, strict=True)], matrix_product(P, M))
    sign = 1 if side == "below" else -1
    gap = [
        [sign * (r * r * P[i][j] - grown[i][j]) - (room if i == j else 0) for j in range(n)] for i in range(n)
    ]
    require(is_positive_definite(gap), "P does not change by more than r^2 in a period")
    if side == "below":
        require(is_positive_definite(P), "P is not positive definite")
    else:
        x = witness["x"].vector(n)
        value = sum((x[i] * P[i][j] * x[j] for i in range(n) for j in range(n)), Fraction(0))
        require(value > 0, "x'Px is not positive")


# --- kind: lower bound of the peak torque -----------------------------------------------------------
#
# No torque in p w(t) T with p < peak takes the start to the target; T is the unit ball, the cube or
# the torques of one-sided thrusters. Proof. H = J w obeys H' = H x J^-1 H + torque. |H|^2 and H'J^-1 H
# are conserved in free motion, so every row M = a I + b J^-1 >= 0 gives a size sqrt(H'M H/L), L the
# largest t'M t over T, that changes at most p w; so does the largest of them, the gauge N of
# K = {H'M_k H <= L_k}. Three arguments follow.
#   momentum    N(start) - N(end) <= p int w.
#   path        travel = int N dt <= N0 s + Nf (tf - s) + p A(s) for any instant s, and it must be at
#               least D: by the rotation angle, or by a potential phi of the modified Rodrigues vector
#               x of m^-1 q with max over K of |phi'| <= rate wherever a path of travel below D can
#               pass, a spherical ellipse {F >= 0, |x| <= outer}. The way may be counted from where a
#               coast leads; see `Departure`.
#   components  (cube, from rest to rest) K is cut down by |H_i| <= beta_i; see `require_components`.
# Maxima over K go by multipliers: G <= sum l_k M_k gives H'G H <= sum l_k L_k.
# Polynomials live on boxes as integers in units of 2^-PEAK_BITS; every rounding is counted. Floats
# only choose multipliers, which are then rounded and checked in integers.

PEAK_BITS = 100
PEAK_BOXES = 150_000
PEAK_CELLS = 96
PEAK_DEGREE = 12
PEAK_COAST_BITS, PEAK_COAST_ORDER, PEAK_COAST_STEPS, PEAK_COAST_CELLS = 192, 40, 400, 32
PEAK_DATA_BITS = 4096
"""Of an inertia's or a window's common denominator: products of longer numbers take minutes."""
Solid = list[list[list[int]]]
"""Coefficients [i][j][k], i + j + k <= degree, of a polynomial of t in [-1, 1]^3."""
Cubic = dict[tuple[int, int, int], Fraction]
Local = tuple[list[int], int]
"""Of a polynomial: constant, slopes 1 to 3, squares 1 to 3, products 23, 13, 12; and a bound of the rest."""
Number = TypeVar("Number", int, Fraction)
Six = list[float]
"""Symmetric 3 by 3 matrix: 11, 12, 13, 22, 23, 33."""


def root_interval(value: Fraction) -> tuple[Fraction, Fraction]:
    """Enclose the square root of a number >= 0."""
    require(value >= 0, "square root of a negative number")
    root = isqrt((value.numerator << 192) // value.denominator)
    return Fraction(root, 1 << 96), Fraction(root + 1, 1 << 96)


def require_short(numbers: Sequence[Fraction], what: str) -> None:
    """Refuse numbers whose sums and products would be too long to compute with."""
    common = 1
    for x in numbers:
        common = lcm(common, x.denominator)
        longest = max(common.bit_length(), x.numerator.bit_length())
        require(longest <= PEAK_DATA_BITS, f"the numbers of the {what} are too long")


def length_interval(values: Sequence[Fraction]) -> tuple[Fraction, Fraction]:
    """Enclose a Euclidean length."""
    return root_interval(sum((x * x for x in values), Fraction(0)))


def arctangent_below(t: Fraction) -> Fraction:
    """Lower bound of atan(t) for 0 <= t < 1: the alternating series cut after a negative term."""
    require(0 <= t < 1, "arctangent outside [0, 1)")
    t = Fraction(math.floor(t * 2**48), 2**48)
    value, power = Fraction(0), t
    for k in range(120):
        value += (-power if k % 2 else power) / (2 * k + 1)
        power *= t * t
    return Fraction(math.floor(value * 2**60), 2**60)


def quadratic(M: Matrix, x: Vector) -> Fraction:
    """Return x'M x."""
    return sum((x[i] * M[i][j] * x[j] for i in range(3) for j in range(3)), Fraction(0))


def combination(weights: Sequence[Fraction], matrices: Sequence[Matrix]) -> Matrix:
    """Sum of 3 by 3 matrices with weights."""
    pairs = list(zip(weights, matrices, strict=True))
    return [[sum((l * M[i][j] for l, M in pairs), Fraction(0)) for j in range(3)] for i in range(3)]


def axis_matrix(i: int) -> Matrix:
    """Return e_i e_i'."""
    return [[Fraction(int(j == k == i)) for k in range(3)] for j in range(3)]


class PeakWindow:
    """Exact integrals of w >= 0 on [0, horizon], piece by piece: up = int w, int up and int up^2."""

    def __init__(self, knots: Vector, shapes: list[Vector]) -> None:
        self.knots, self.shapes = knots, shapes
        self.first, self.second, self.squares = [Fraction(0)], [Fraction(0)], [Fraction(0)]
        self.rises: list[tuple[Vector, Vector, Vector]] = []
        for (a, b), shape in zip(pairwise(knots), shapes, strict=True):
            one = [self.first[-1]] + [c * (b - a) / (i + 1) for i, c in enumerate(shape)]
            two = [self.second[-1]] + [c * (b - a) / (i + 1) for i, c in enumerate(one)]
            three = [self.squares[-1]] + [c * (b - a) for c in _primitive(_times(one, one))[1:]]
            self.rises.append((one, two, three))
            self.first.append(sum(one, Fraction(0)))
            self.second.append(sum(two, Fraction(0)))
            self.squares.append(sum(three, Fraction(0)))

    @classmethod
    def read(cls, place: Node) -> PeakWindow:
        """Read and check the profile."""
        knots, shapes = place["knots"].vector(), [shape.vector() for shape in place["shapes"].items()]
        require_short([*knots, *(c for shape in shapes for c in shape)], "window")
        fits = len(knots) == len(shapes) + 1 >= 2 and knots[0] == 0
        require(fits, "window: knots and shapes disagree")
        require(all(a < b for a, b in pairwise(knots)), "window: knots must increase")
        for shape in shapes:
            sure = from_powers(shape or [Fraction(0)]).is_nonnegative(20)
            require(sure, "window: the profile is not proved >= 0")
        return cls(knots, shapes)

    def mirrored(self) -> PeakWindow:
        """Return the profile with time running backwards."""
        horizon, one = self.knots[-1], Fraction(1)
        shapes = [_compose(shape, one, -one) for shape in reversed(self.shapes)]
        return PeakWindow([horizon - k for k in reversed(self.knots)], shapes)

    def _at(self, t: Fraction, order: int) -> Fraction:
        require(0 <= t <= self.knots[-1], "the instant must lie within the transfer")
        i = min(bisect_right(self.knots, t), len(self.rises)) - 1
        x = (t - self.knots[i]) / (self.knots[i + 1] - self.knots[i])
        value = Fraction(0)
        for c in reversed(self.rises[i][order]):
            value = value * x + c
        return value

    def area(self, s: Fraction) -> Fraction:
        """int_0^s up + int_s^tf (total - up)."""
        inner = self._at(s, 1)
        return inner + self.first[-1] * (self.knots[-1] - s) - (self.second[-1] - inner)

    def opened(self, s: Fraction) -> Fraction:
        """int_0^s up."""
        return self._at(s, 1)

    def moment(self, a: Fraction, b: Fraction, about: Fraction) -> Fraction:
        """int_a^b w(t) (about - t) dt, by parts."""
        ends = self._at(b, 0) * (about - b) - self._at(a, 0) * (about - a)
        return ends + self._at(b, 1) - self._at(a, 1)

    def cells(self, until: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
        """Cut [0, until]: on each cell int up, and a bound of (int_0^t up^2)/up, both rounded up."""
        inside = {k for k in self.knots if 0 < k < until}
        edges = sorted({until * k / PEAK_CELLS for k in range(PEAK_CELLS + 1)} | inside)
        for a, b in pairwise(edges):
            up, ratio = self._at(a, 0), self._at(b, 1)  # up rises: int up^2 <= up int up
            if up > 0:
                ratio = min(ratio, self._at(b, 2) / up)
            area = self._at(b, 1) - self._at(a, 1)
            if area > 0:
                yield rounded_up(area), rounded_up(ratio)


def rounded_up(x: Fraction) -> Fraction:
    """Round up to a multiple of 2^-80."""
    return Fraction(math.ceil(x * 2**80), 2**80)


def quaternion_times(a: Sequence[Number], b: Sequence[Number]) -> list[Number]:
    """Hamilton product, scalar first."""
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + b[0] * a[1] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + b[0] * a[2] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + b[0] * a[3] + a[1] * b[2] - a[2] * b[1],
    ]


def cubic_sum(*terms: Cubic) -> Cubic:
    """Sum of polynomials in three variables."""
    result: Cubic = {}
    for term in terms:
        for e, c in term.items():
            result[e] = result.get(e, Fraction(0)) + c
    return result


def cubic_times(p: Cubic, q: Cubic) -> Cubic:
    """Product."""
    result: Cubic = {}
    for a, x in p.items():
        for b, y in q.items():
            e = (a[0] + b[0], a[1] + b[1], a[2] + b[2])
            result[e] = result.get(e, Fraction(0)) + x * y
    return result


def cubic_scale(p: Cubic, factor: Fraction) -> Cubic:
    """Multiple."""
    return {e: factor * c for e, c in p.items()}


def cubic_at(p: Cubic, centre: Vector) -> Cubic:
    """Taylor coefficients at a point."""
    result: Cubic = {}
    for (a, b, c), value in p.items():
        for i in range(a + 1):
            for j in range(b + 1):
                for k in range(c + 1):
                    factor = comb(a, i) * comb(b, j) * comb(c, k)
                    moved = centre[0] ** (a - i) * centre[1] ** (b - j) * centre[2] ** (c - k)
                    result[(i, j, k)] = result.get((i, j, k), Fraction(0)) + value * factor * moved
    return result


class PeakChart:
    """Coordinates x / outer about a middle attitude m, and the region of short paths in them."""

    def __init__(self, place: Node) -> None:
        self.middle, self.direction = place["middle"].vector(3), place["direction"].vector(3)
        self.inner, self.outer = place["inner"].number(), place["outer"].number()
        require(sum(c * c for c in self.direction) == 1, "the direction must be of length 1")
        require(0 <= self.inner <= self.outer < 1 and self.outer > 0, "expected 0 <= inner <= outer < 1")
        square = sum((c * c for c in self.middle), Fraction(0))
        self.quaternion = [(1 - square) / (1 + square)] + [2 * c / (1 + square) for c in self.middle]

    def region(self) -> list[Cubic]:
        """F and 1 - |x / outer|^2: both >= 0 wherever the path can be."""
        t, h = self.outer, self.inner
        one: Cubic = {(0, 0, 0): Fraction(1)}
        unit: Cubic = {(2, 0, 0): Fraction(1), (0, 2, 0): Fraction(1), (0, 0, 2): Fraction(1)}
        along = {(1, 0, 0): self.direction[0], (0, 1, 0): self.direction[1], (0, 0, 1): self.direction[2]}
        less = cubic_sum(one, cubic_scale(unit, -(t**2)))
        more = cubic_sum(one, cubic_scale(unit, t**2))
        cosines = ((1 - h**2) / (1 + h**2) * (1 + t**2) / (1 - t**2)) ** 2
        sines = (h / (1 + h**2) * (1 + t**2) / t) ** 2
        first = cubic_scale(cubic_times(less, less), cosines)
        second = cubic_scale(cubic_times(along, along), 4 * t**2 * sines)
        ellipse = cubic_sum(first, second, cubic_scale(cubic_times(more, more), Fraction(-1)))
        return [ellipse, cubic_sum(one, cubic_scale(unit, Fraction(-1)))]

    def locate(self, q: Vector) -> tuple[Vector, Fraction]:
        """Modified Rodrigues vector of m^-1 q/|q| and a bound of the error of each component."""
        m = self.quaternion
        r = quaternion_times([m[0], -m[1], -m[2], -m[3]], q)
        low, high = length_interval(q)
        require(r[0] + low > 0, "the start is opposite to the middle of the chart")
        x = [c / (r[0] + high) for c in r[1:]]
        error = max(abs(c) for c in r[1:]) * (high - low) / (r[0] + low) ** 2
        rounded = [Fraction(round(c * 2**96), 2**96) for c in x]
        return rounded, error + Fraction(1, 2**96)

    def arc_to_model(self, x: Vector, side: int) -> Fraction:
        """Upper bound of the arc from x to a model end point: the metric is at most 2 |dx|."""
        return (
            2
            * length_interval([c - side * self.inner * n for c, n in zip(x, self.direction, strict=True)])[1]
        )


def largest_near(p: Cubic, centre: Vector, radius: Fraction) -> Fraction:
    """Upper bound of a polynomial within a distance of a point."""
    local = cubic_at(p, centre)
    value = local.pop((0, 0, 0), Fraction(0))
    slopes = [local.pop(e, Fraction(0)) for e in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    value += length_interval(slopes)[1] * radius
    return value + sum((abs(c) * radius ** sum(e) for e, c in local.items()), Fraction(0))


def rate_polynomials(phi: Cubic, inverse: Matrix, t: Fraction) -> list[Cubic]:
    """1/4 J^-1 [(1 - |x|^2) g - 2 x cross g + 2 (x.g) x] for g = grad phi, in scaled coordinates x / t."""
    g: list[Cubic] = []
    x: list[Cubic] = []
    for axis in range(3):
        unit = tuple(int(i == axis) for i in range(3))
        x.append({(unit[0], unit[1], unit[2]): Fraction(1)})
        slope: Cubic = {}
        for e, c in phi.items():
            if e[axis]:
                slope[(e[0] - unit[0], e[1] - unit[1], e[2] - unit[2])] = e[axis] * c
        g.append(slope)
    square = cubic_sum(*(cubic_times(a, a) for a in x))
    dot = cubic_sum(*(cubic_times(a, b) for a, b in zip(x, g, strict=True)))
    body = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        swirl = cubic_sum(cubic_times(x[j], g[k]), cubic_scale(cubic_times(x[k], g[j]), Fraction(-1)))
        straight = cubic_sum(cubic_scale(g[i], 1 / t), cubic_scale(cubic_times(square, g[i]), -t))
        bent = cubic_scale(cubic_times(x[i], dot), 2 * t)
        body.append(cubic_sum(straight, cubic_scale(swirl, Fraction(-2)), bent))
    return [cubic_sum(*(cubic_scale(body[j], inverse[i][j] / 4) for j in range(3))) for i in range(3)]


def as_solid(p: Cubic, degree: int) -> Solid:
    """Integer coefficients, each rounded down by less than one unit."""
    span = range(degree + 1)
    return [
        [
            [math.floor(p.get((i, j, k), Fraction(0)) * 2**PEAK_BITS) for k in range(degree + 1 - i - j)]
            for j in range(degree + 1 - i)
        ]
        for i in span
    ]


def rounding_units(degree: int) -> int:
    """Bound, in units and absolute sum, of what one cut or the first rounding adds to a polynomial's error.

    A rounded coefficient of t^k is then moved by a half: its error is multiplied by at most 2^k.
    """
    return (degree + 1) * (degree + 2) * (degree + 3) // 6 << degree


def cut_solid(p: Solid) -> tuple[Solid, Solid]:
    """Both halves along the last coordinate, as polynomials of (last, first, middle).

    t = +-1/2 + t'/2: every coefficient is halved, rounded down, and moved by additions only. The
    absolute sum of an error there was does not grow; `rounding_units` bounds what is added.
    """
    size = len(p)
    low: Solid = [[[0] * (size - i - j) for j in range(size - i)] for i in range(size)]
    high: Solid = [[[0] * (size - i - j) for j in range(size - i)] for i in range(size)]
    for i, plane in enumerate(p):
        for j, line in enumerate(plane):
            up = [c >> k for k, c in enumerate(line)]
            down = list(up)
            for start in range(len(line) - 1):
                for k in range(len(line) - 2, start - 1, -1):
                    up[k] += up[k + 1]
                    down[k] -= down[k + 1]
            for k in range(len(line)):
                high[k][i][j] = up[k]
                low[k][i][j] = down[k]
    return low, high


def solid_sum(p: Solid) -> int:
    """Sum of the absolute values of all coefficients but the constant."""
    return sum(abs(c) for plane in p for line in plane for c in line) - abs(p[0][0][0])


def local(p: Solid, error: int) -> Local:
    """Coefficients up to second order, and a bound of everything else with the error."""
    c = [p[0][0][0], p[1][0][0], p[0][1][0], p[0][0][1], p[2][0][0], p[0][2][0], p[0][0][2]]
    c += [p[0][1][1], p[1][0][1], p[1][1][0]]
    return c, solid_sum(p) - sum(map(abs, c[1:])) + error


def square_above(v: list[Local], side: Local, limit: int) -> int:
    """Upper bound of |v|^2 where the polynomial `side` is >= 0 on the box, units 2^-2 PEAK_BITS.

    Second-order terms of the square are formed before absolute values are taken. If that is above
    the limit, a multiple of `side` is added so that slopes outwards of the region cancel.
    """
    total, beyond = [0] * 10, 0
    for (c, d1, d2, d3, q1, q2, q3, m1, m2, m3), tail in v:
        turn = abs(d1) + abs(d2) + abs(d3)
        bend = abs(q1) + abs(q2) + abs(q3) + abs(m1) + abs(m2) + abs(m3)
        two = 2 * c
        total[0] += c * c
        total[1] += two * d1
        total[2] += two * d2
        total[3] += two * d3
        total[4] += two * q1 + d1 * d1
        total[5] += two * q2 + d2 * d2
        total[6] += two * q3 + d3 * d3
        total[7] += two * m1 + 2 * d2 * d3
        total[8] += two * m2 + 2 * d1 * d3
        total[9] += two * m3 + 2 * d1 * d2
        beyond += 2 * (abs(c) + turn + bend) * tail + tail * tail + 2 * turn * bend + bend * bend
    least = _largest_quadratic(total) + beyond
    slopes, rest = side
    steep = sum(x * x for x in slopes[1:4])
    if least > limit and steep:
        lean = -(slopes[1] * total[1] + slopes[2] * total[2] + slopes[3] * total[3])
        tries = [lean // steep, *(-total[a] // slopes[a] for a in (1, 2, 3) if slopes[a])]
        for factor in tries:
            if factor > 0:
                moved = [x + factor * y for x, y in zip(total, slopes, strict=True)]
                least = min(least, _largest_quadratic(moved) + beyond + factor * rest)
    return least


def _largest_quadratic(c: list[int]) -> int:
    """Upper bound on [-1, 1]^3 of the quadratic with these coefficients, in the order of `Local`."""
    squares = max(c[4], 0) + max(c[5], 0) + max(c[6], 0)
    slopes, products = abs(c[1]) + abs(c[2]) + abs(c[3]), abs(c[7]) + abs(c[8]) + abs(c[9])
    return c[0] + slopes + squares + products


class Gauge:
    """K = {H'M_k H <= L_k}: a set of momenta, and the gauge N that grows by at most p w."""

    def __init__(self, J: Matrix, torques: list[Vector] | None, rows: list[Vector]) -> None:
        self.J, self.inverse = J, inverse_matrix(J)
        unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
        self.rows = [combination(pair, [unit, self.inverse]) for pair in rows]
        require(bool(rows), "the set of momenta has no rows")
        for M in self.rows:
            require(is_positive_semidefinite(M), "a row of the set of momenta is not positive semidefinite")
        if torques is None:
            require(all(b == 0 for _, b in rows), "the unit ball of torques has rows with b = 0 only")
            self.levels = [a for a, _ in rows]
        else:
            self.levels = [max(quadratic(M, t) for t in torques) for M in self.rows]
        require(all(level > 0 for level in self.levels), "a row of the set of momenta bounds no torque")
        self.box: Vector | None = None

    def with_box(self, box: Vector) -> Gauge:
        """Return the part with |H_i| <= box[i]."""
        require(all(b > 0 for b in box), "the half widths of a box must be positive")
        part = Gauge.__new__(Gauge)
        part.J, part.inverse, part.box = self.J, self.inverse, box
        part.rows = self.rows + [axis_matrix(i) for i in range(3)]
        part.levels = self.levels + [b * b for b in box]
        return part

    def size(self, H: Vector) -> tuple[Fraction, Fraction]:
        """Enclose the gauge of a momentum."""
        if not any(H):
            return Fraction(0), Fraction(0)
        pairs = [root_interval(quadratic(M, H) / L) for M, L in zip(self.rows, self.levels, strict=True)]
        return max(low for low, _ in pairs), max(high for _, high in pairs)

    def require_rates_within(self, rate: Fraction, size: Fraction) -> None:
        """Prove that the gauge of J w is at most `size` for every |w| <= rate."""
        require(rate >= 0 and size >= 0, "rates and sizes must not be negative")
        unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
        columns = [list(column) for column in zip(*self.J, strict=True)]
        for M, L in zip(self.rows, self.levels, strict=True):
            moved = [
                [sum((x * y for x, y in zip(row, c, strict=True)), Fraction(0)) for c in columns] for row in M
            ]
            form = [
                [sum((self.J[i][k] * moved[k][j] for k in range(3)), Fraction(0)) for j in range(3)]
                for i in range(3)
            ]
            gap = combination([size**2 * L, -(rate**2)], [unit, form])
            require(is_positive_semidefinite(gap), "the size of the terminal rate is not proved")

    def largest(self, G: Matrix, weights: Vector) -> Fraction:
        """Upper bound of H'G H over K, by multipliers of the rows."""
        require(all(l >= 0 for l in weights), "multipliers must not be negative")
        gap = combination([*weights, Fraction(-1)], [*self.rows, G])
        require(is_positive_semidefinite(gap), "multipliers do not dominate their form")
        return sum((l * L for l, L in zip(weights, self.levels, strict=True)), Fraction(0))

    def speed(self, weights: Vector) -> Fraction:
        """Upper bound of |J^-1 H| over K."""
        A = self.inverse
        square = [
            [sum((A[i][k] * A[k][j] for k in range(3)), Fraction(0)) for j in range(3)] for i in range(3)
        ]
        return root_interval(self.largest(square, weights))[1]


class Metrics:
    """Ellipsoids around K: matrices F, in units of 2^-shift, with max over K of v.H <= |F v| for every v.

    That holds if F Q F' >= (sum of l_k) I for Q = sum l_k M_k/L_k, whatever the l_k >= 0: on K,
    (v.H)^2 <= (v'Q^-1 v)(H'Q H). Floats choose l; Q is rounded down, F Q F' is decided in integers.
    """

    def __init__(self, gauge: Gauge) -> None:
        rows = [[[x / L for x in row] for row in M] for M, L in zip(gauge.rows, gauge.levels, strict=True)]
        largest = max(M[i][i] for M in rows for i in range(3))
        self._fine = 64 - _magnitude(largest)
        scale = Fraction(2) ** self._fine
        self._exact = [
            [[math.floor(M[i][j] * scale) - 4 * (i == j) for j in range(3)] for i in range(3)] for M in rows
        ]
        self._rows = [
            (float(M[0][0]), float(M[0][1]), float(M[0][2]), float(M[1][1]), float(M[1][2]), float(M[2][2]))
            for M in rows
        ]
        self.shift = 40 + _magnitude(largest) // 2
        self.even = [1.0 / len(rows)] * len(rows)
        self.fixed = len(rows) == 1
        self._known: dict[tuple[int, int, int], tuple[list[float], list[list[int]] | None]] = {}

    def about(self, v: list[float]) -> tuple[list[float], list[list[int]] | None]:
        """Multipliers and F that are good for v near this direction; remembered."""
        size = sum(map(abs, v)) or 1.0
        place = (round(24 * v[0] / size), round(24 * v[1] / size), round(24 * v[2] / size))
        if place not in self._known:
            a, b, c = (x / 24 for x in place)
            spread = [a * a + 1e-4, a * b, a * c, b * b + 1e-4, b * c, c * c + 1e-4]
            weights = self.improved(spread, self.even, 200)
            self._known[place] = weights, self.factor(weights)
        return self._known[place]

    def improved(self, spread: Six, weights: list[float], sweeps: int) -> list[float]:
        """Multipliers that nearly minimise the mean of |F v|^2, by its multiplicative iteration."""
        c0, c1, c2, c3, c4, c5 = spread
        for _ in range(sweeps):
            q0, q1, q2, q3, q4, q5 = self._sum(weights)
            i0, i1, i2 = q3 * q5 - q4 * q4, q2 * q4 - q1 * q5, q1 * q4 - q2 * q3
            i3, i4, i5 = q0 * q5 - q2 * q2, q1 * q2 - q0 * q4, q0 * q3 - q1 * q1
            a0, a1, a2 = i0 * c0 + i1 * c1 + i2 * c2, i0 * c1 + i1 * c3 + i2 * c4, i0 * c2 + i1 * c4 + i2 * c5
            b0, b1, b2 = i1 * c0 + i3 * c1 + i4 * c2, i1 * c1 + i3 * c3 + i4 * c4, i1 * c2 + i3 * c4 + i4 * c5
            d0, d1, d2 = i2 * c0 + i4 * c1 + i5 * c2, i2 * c1 + i4 * c3 + i5 * c4, i2 * c2 + i4 * c4 + i5 * c5
            s0, s1, s2 = a0 * i0 + a1 * i1 + a2 * i2, a0 * i1 + a1 * i3 + a2 * i4, a0 * i2 + a1 * i4 + a2 * i5
            s3, s4, s5 = b0 * i1 + b1 * i3 + b2 * i4, b0 * i2 + b1 * i4 + b2 * i5, d0 * i2 + d1 * i4 + d2 * i5
            loads = [
                m0 * s0 + m3 * s3 + m5 * s5 + 2 * (m1 * s1 + m2 * s2 + m4 * s4)
                for m0, m1, m2, m3, m4, m5 in self._rows
            ]
            moved = [l * math.sqrt(x) if x > 0 else 0.0 for l, x in zip(weights, loads, strict=True)]
            total = sum(moved)
            if not 0 < total < math.inf:
                break
            weights = [l / total + 1e-7 for l in moved]
        return weights

    def _sum(self, weights: list[float]) -> Six:
        return [sum(l * m[k] for l, m in zip(weights, self._rows, strict=True)) for k in range(6)]

    def factor(self, weights: list[float]) -> list[list[int]] | None:
        """F for the multipliers, proved; None if it does not come out."""
        total = sum(weights) * (1 + 1e-9)
        q0, q1, q2, q3, q4, q5 = (x / total for x in self._sum(weights))
        try:
            g0 = math.sqrt(q0)
            g1, g2 = q1 / g0, q2 / g0
            g3 = math.sqrt(q3 - g1 * g1)
            g4 = (q4 - g1 * g2) / g3
            g5 = math.sqrt(q5 - g2 * g2 - g4 * g4)
            f0, f3, f5 = 1 / g0, 1 / g3, 1 / g5
            f1, f4 = -g1 * f0 * f3, -g4 * f3 * f5
            f2 = -(g2 * f0 + g4 * f1) * f5
            scale = 2.0**self.shift
            F = [
                [round(f0 * scale), 0, 0],
                [round(f1 * scale), round(f3 * scale), 0],
                [round(f2 * scale), round(f4 * scale), round(f5 * scale)],
            ]
            lots = [round(l * 2**50) for l in weights]
        except (ArithmeticError, ValueError):
            return None
        Q = [
            [sum(map(mul, lots, column)) for column in zip(*lines, strict=True)]
            for lines in zip(*self._exact, strict=True)
        ]
        FQ = [[sum(map(mul, row, column)) for column in zip(*Q, strict=True)] for row in F]
        G = [[sum(map(mul, row, other)) for other in F] for row in FQ]
        least = sum(lots) * Fraction(2) ** (self._fine + 2 * self.shift)
        for i in range(3):
            G[i][i] -= math.ceil(least)
        first = G[0][0] * G[1][1] - G[0][1] * G[1][0]
        det = (
            G[2][2] * first
            - G[1][2] * (G[0][0] * G[2][1] - G[0][1] * G[2][0])
            + G[0][2] * (G[1][0] * G[2][1] - G[1][1] * G[2][0])
        )
        return F if G[0][0] > 0 and first > 0 and det > 0 else None

    def apply(self, F: list[list[int]], v: list[Local]) -> list[Local]:
        """Return F v, rounding included in the bound of the rest."""
        (p, q, r), tails = [c for c, _ in v], [tail for _, tail in v]
        shift, result = self.shift, []
        for a, b, c in F:
            values = [(a * x + b * y + c * z) >> shift for x, y, z in zip(p, q, r, strict=True)]
            rest = (abs(a) * tails[0] + abs(b) * tails[1] + abs(c) * tails[2]) >> shift
            result.append((values, rest + 11))
        return result


def _magnitude(x: Fraction) -> int:
    """Exponent e with x near 2^e."""
    return x.numerator.bit_length() - x.denominator.bit_length()


def components_above(v: list[Solid], box: list[int], error: int) -> int:
    """Upper bound of sum box_i |v_i| over the cube: sharp where no component changes its sign."""
    signs, flips = [], 0
    for p, width in zip(v, box, strict=True):
        reach = solid_sum(p) - abs(p[0][0][0]) + error
        flips += 2 * max(reach, 0) * width
        signs.append(width if p[0][0][0] >= 0 else -width)
    a, b, c = signs
    p, q, r = v
    total = 0
    for lines in zip(p, q, r, strict=True):
        for rows in zip(*lines, strict=True):
            total += sum(abs(a * x + b * y + c * z) for x, y, z in zip(*rows, strict=True))
    middle = a * p[0][0][0] + b * q[0][0][0] + c * r[0][0][0]
    return total - abs(middle) + middle + flips + error * sum(box)


@dataclass
class RateBox:
    """One box of the search: the rate and the region on it, its depth, its error and an ellipsoid to try."""

    v: list[Solid]
    region: list[Solid]
    depth: int
    error: int
    weights: list[float]
    F: list[list[int]] | None


class RateProof:
    """Proof that v.H <= rate for every H in K wherever the region polynomials are >= 0, by cutting boxes."""

    def __init__(self, gauge: Gauge, rate: Fraction) -> None:
        self.metrics = Metrics(gauge)
        self.limit: int = math.floor(rate * rate * 2 ** (2 * PEAK_BITS))
        self.linear: int = math.floor(rate * 2 ** (PEAK_BITS + 30))
        self.box = None if gauge.box is None else [math.ceil(b * 2**30) for b in gauge.box]
        self.crumb: int = math.floor(rate * 2 ** (PEAK_BITS - 17))
        self.count = 0

    def run(self, v: list[Cubic], region: list[Cubic]) -> int:
        """Prove it; return how many boxes were needed."""
        degree = max(2, *(sum(e) for p in v for e in p))
        sides = [as_solid(p, max(2, *(sum(e) for e in p))) for p in region]
        first = [as_solid(p, degree) for p in v]
        stack = [RateBox(first, sides, 0, rounding_units(degree), self.metrics.even, None)]
        while stack:
            box = stack.pop()
            self.count += 1
            require(self.count <= PEAK_BOXES and box.depth < 80, "the rate of the potential is not proved")
            slack = [rounding_units(len(p) - 1) * (box.depth + 1) for p in box.region]
            if any(p[0][0][0] + solid_sum(p) + e < 0 for p, e in zip(box.region, slack, strict=True)):
                continue
            if not self._holds(box, local(box.region[0], slack[0])):
                stack += self._halves(box)
        return self.count

    def _holds(self, box: RateBox, side: Local) -> bool:
        """Whether the rate is proved on a box: by an ellipsoid (the parent's, a known, its own) or else."""
        v, metrics, limit = [local(p, box.error) for p in box.v], self.metrics, self.limit
        if box.F is not None:
            value = square_above(metrics.apply(box.F, v), side, limit)
            if value <= limit:
                return True
            if metrics.fixed or value > 4 * limit:
                return False
        unit = 2.0**-PEAK_BITS
        columns = [[float(c[k]) * unit for c, _ in v] for k in range(4)]
        box.weights, box.F = metrics.about(columns[0])
        if self._fits(box.F, v, side):
            return True
        spread = [
            sum(x[i] * x[j] for x in columns) for i, j in ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
        ]
        sweeps = 5 if box.depth < 20 else 40 if box.depth < 32 else 300
        box.weights = metrics.improved(spread, box.weights, sweeps)
        box.F = metrics.factor(box.weights)
        if self._fits(box.F, v, side):
            return True
        if self.box is None:
            return False
        return components_above(box.v, self.box, box.error) <= self.linear

    def _fits(self, F: list[list[int]] | None, v: list[Local], side: Local) -> bool:
        return F is not None and square_above(self.metrics.apply(F, v), side, self.limit) <= self.limit

    def _halves(self, box: RateBox) -> list[RateBox]:
        """Cut a box in two; terms of high order that no longer matter join the error."""
        v, error = box.v, box.error
        while len(v[0]) > 5:
            top = max(sum(abs(c) for plane in p for line in plane for c in line[-1:]) for p in v)
            if top > self.crumb:
                break
            v, error = [[[line[:-1] for line in plane[:-1]] for plane in p[:-1]] for p in v], error + top
        error += rounding_units(len(v[0]) - 1)
        cut, sides = [cut_solid(p) for p in v], [cut_solid(p) for p in box.region]
        return [
            RateBox([c[i] for c in cut], [c[i] for c in sides], box.depth + 1, error, box.weights, box.F)
            for i in (0, 1)
        ]


def travel_by_angle(q: Vector, arc: Fraction, speed: Fraction) -> Fraction:
    """Travel from the angle alone: twice the arc left outside the tolerance, over the fastest rate."""
    low, high = length_interval(q)
    vector = length_interval(q[1:])
    pi = Fraction(3141592653589793238, 10**18)
    if q[0] >= 0:
        t = vector[0] / (high + q[0])
        reached = 2 * arctangent_below(t) if t < 1 else pi / 2
        if Fraction(7, 10) <= t < 1:
            reached = pi / 2 - 2 * _arctangent_above((1 - t) / (1 + t))
    else:
        reached = pi - 2 * _arctangent_above(vector[1] / (low - q[0]))
    return 2 * (reached - arc) / speed


def _arctangent_above(t: Fraction) -> Fraction:
    """Upper bound of atan(t), t >= 0."""
    quarter = Fraction(3141592653589793239, 4 * 10**18)
    if t <= Fraction(1, 100):
        return t - t**3 / 3 + t**5 / 5
    if t >= 1:
        return quarter + (t - 1)
    return quarter - arctangent_below((1 - t) / (1 + t))


@dataclass(frozen=True)
class PeakTarget:
    """Terminal tolerance as an arc and as a chord of the sphere of quaternions, rounded up."""

    arc: Fraction
    chord: Fraction

    @classmethod
    def of(cls, radius: Fraction) -> PeakTarget:
        """Targets |bv| <= radius."""
        require(0 <= radius < 1, "the terminal tolerance must lie in [0, 1)")
        if radius == 0:
            return cls(Fraction(0), Fraction(0))
        cosine = root_interval(1 - radius**2)[0]
        require(cosine > 0, "the terminal tolerance is too large")
        return cls(radius / cosine, root_interval(2 - 2 * cosine)[1])

    def radius(self, x: Vector) -> Fraction:
        """Upper bound of the distance in the chart from x to any target around it."""
        size = length_interval(x)[1]
        require(size + self.chord <= 1, "the terminal tolerance is too large for the chart")
        reach = self.chord
        for _ in range(3):
            reach = min(reach, self.chord * root_interval((1 + size**2) * (1 + (size + reach) ** 2))[1] / 2)
            reach = Fraction(math.ceil(reach * 2**60), 2**60)
        return reach


def read_potential(place: Node) -> Cubic:
    """Read a polynomial of three variables: rows of three exponents and a coefficient."""
    phi: Cubic = {}
    for entry in place.items():
        i, j, k, c = entry.vector(4)
        sound = all(x.denominator == 1 and x >= 0 for x in (i, j, k)) and i + j + k <= PEAK_DEGREE
        require(sound, f"exponents must be integers of sum at most {PEAK_DEGREE}")
        exponent = (int(i), int(j), int(k))
        require(exponent not in phi and any(exponent), "a term of the potential is constant or given twice")
        phi[exponent] = c
    require(bool(phi), "the potential has no terms")
    return phi


def require_separation(
    place: Node, gauge: Gauge, speed: Fraction, q: Vector, target: PeakTarget, travel: Fraction
) -> str:
    """Prove that every motion from q to the quaternion +1 travels at least `travel`."""
    if place["by"].text() == "angle":
        enough = travel_by_angle(q, target.arc, speed) >= travel
        require(enough, "the rotation angle does not give the travel")
        return "by the rotation angle"
    require(place["by"].text() == "potential", "a separation is by angle or by potential")
    chart, phi = PeakChart(place["chart"]), read_potential(place["potential"])
    rate = place["rate"].number()
    require(rate > 0, "the rate must be positive")
    start, error = chart.locate(q)
    end = [-c for c in chart.middle]
    slack = chart.arc_to_model(start, 1) + 4 * error + chart.arc_to_model(end, -1) + target.arc
    reach = 2 * (4 * arctangent_below(chart.outer) - slack) / speed
    require(reach >= travel, "a path of that travel may leave the region")
    t = chart.outer
    high = largest_near(phi, [c / t for c in end], target.radius(end) / t)
    low = -largest_near(cubic_scale(phi, Fraction(-1)), [c / t for c in start], 2 * error / t)
    require(low - high >= travel * rate, "the potential does not differ enough between start and target")
    count = RateProof(gauge, rate).run(rate_polynomials(phi, gauge.inverse, t), chart.region())
    return f"by a potential of degree {max(sum(e) for e in phi)}, proved on {count} boxes"


@dataclass(frozen=True)
class Transfer:
    """What a bound of the peak speaks about."""

    J: Matrix
    window: PeakWindow
    attitude: Vector
    rate: Vector
    tolerance: Fraction
    end_rate: Fraction
    signs: Vector
    torques: list[Vector] | None
    words: str
    unit: str

    @classmethod
    def read(cls, data: Node) -> Transfer:
        """Read and check the transfer of the data."""
        require_short([x for row in data["inertia"].matrix(3, 3) for x in row], "inertia")
        J, place = read_inertia(data), data["transfer"]
        torques, words, unit = read_torques(place["torque"])
        q, w, signs = (
            place["attitude"].vector(4),
            place["rate"].vector(3),
            place["signs"].vector(),
        )
        require(any(q), "the start attitude must not be zero")
        require(signs in ([1], [-1], [1, -1], [-1, 1]), "target signs are +1, -1 or both")
        tolerance, end_rate = (place["tolerance"][name].number() for name in ("attitude", "rate"))
        require(0 <= tolerance < 1, "the terminal tolerance must lie in [0, 1)")
        require(end_rate >= 0, "the terminal rate tolerance must not be negative")
        window = PeakWindow.read(place["window"])
        return cls(J, window, q, w, tolerance, end_rate, signs, torques, words, unit)

    @property
    def momentum(self) -> Vector:
        """J w at the start."""
        return image(self.J, self.rate)

    def describe(self) -> list[str]:
        """Return the transfer for people."""
        ends = " or ".join(f"{int(x):+d}" for x in self.signs)
        return [
            f"inertia J = {show_matrix(self.J)} kg m^2,",
            f"transfer time {show(self.window.knots[-1])} s, integral of the window profile "
            f"{show(self.window.first[-1])} s,",
            f"start quaternion along ({', '.join(show(c) for c in self.attitude)}),",
            f"start rate ({', '.join(show(c) for c in self.rate)}) rad/s, target quaternion {ends},",
            f"terminal tolerance |bv| <= {show(self.tolerance)}, |w| <= {show(self.end_rate)} rad/s;",
        ]


def read_torques(place: Node) -> tuple[list[Vector] | None, str, str]:
    """Return points whose convex hull holds the torques of unit peak (None: the ball), words and unit."""
    by = place["by"].text()
    if by == "euclidean":
        return None, "|torque(t)| <= p w(t)", "N m"
    signs = [Fraction(1), Fraction(-1)]
    if by == "component":
        cube = [[a, b, c] for a in signs for b in signs for c in signs]
        return cube, "every |torque_i(t)| <= p w(t)", "N m"
    require(by == "thrusters", "torque is limited by euclidean, component or thrusters")
    axes = place["axes"].matrix(None, 3)
    require(0 < len(axes) <= 12, "expected 1 to 12 thrusters")
    sums: list[Vector] = [[Fraction(0)] * 3]
    for axis in axes:
        sums += [[x + y for x, y in zip(point, axis, strict=True)] for point in sums]
    return sums, f"torque = B f, 0 <= f_j <= p w(t), columns of B {show_matrix(axes)} m,", "N"


@kind("peak-lower-bound")
def check_peak_lower_bound(data: Node, certificate: Node) -> list[str]:
    """Prove that no torque of a smaller peak makes the transfer."""
    d, witness, peak = Transfer.read(data), certificate["witness"], certificate["claim"]["peak"].number()
    require(peak > 0 and d.window.first[-1] > 0, "the peak must be positive and the window must open")
    gauge = Gauge(d.J, d.torques, [row.vector(2) for row in witness["rows"].items()])
    arguments = {"momentum": require_momentum, "path": require_path, "components": require_components}
    name = witness["argument"].text()
    require(name in arguments, "the argument is momentum, path or components")
    return [
        f"no torque with {d.words} and p < {show(peak)} {d.unit} takes the start to the target:",
        *d.describe(),
        arguments[name](d, gauge, peak, witness),
    ]


def require_momentum(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """N must fall from the start to the end by what windows and peak allow."""
    end = witness["end"].number()
    gauge.require_rates_within(d.end_rate, end)
    start = gauge.size(d.momentum)[0]
    require(start - end >= peak * d.window.first[-1], "a torque of that peak may absorb the momentum")
    return "the momentum cannot be absorbed by less"


def require_path(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """Windows and peak allow less travel than the way takes."""
    travel, s, end = (witness[name].number() for name in ("travel", "instant", "end"))
    gauge.require_rates_within(d.end_rate, end)
    start, horizon = gauge.size(d.momentum)[1], d.window.knots[-1]
    after = Departure.read(d, gauge, witness["coast"]) if witness.has("coast") else Departure.none(d)
    require(after.until <= s <= horizon, "the instant must lie within the transfer, after the coast")
    area = d.window.area(s) - d.window.opened(after.until) + after.deviation
    allowed = start * (s - after.until) + end * (horizon - s) + after.slack + peak * area
    require(allowed <= travel, "a transfer of that peak may travel enough")
    d = replace(d, attitude=after.attitude)
    return after.words + require_travel(d, gauge, gauge.speed(witness["speed"].vector()), travel, witness)


@dataclass(frozen=True)
class Departure:
    """Where the way is counted from: the start, or an attitude near C(until), where a coast leads.

    C keeps the momentum H0 of the start, fixed in space. Let d be the rest of the momentum in body axes
    and e the least travel that joins C to the attitude. Rows have the form a I + b J^-1, so that
        N(d)' <= p w + nu N(d),        e' <= N(d) + mu e
    with nu of d -> -(J^-1 h) x d and mu of y -> h x J^-1 y - J (J^-1 h x J^-1 y), |h| = |H0|; hence
    e(until) <= p int w(t) u (exp(mu u) + exp(nu u))/2 dt, u = until - t. From there on the travel to the
    target is what is left of the transfer, and `slack` joins C(until) to the attitude stated.
    """

    until: Fraction
    attitude: Vector
    deviation: Fraction
    slack: Fraction
    words: str

    @classmethod
    def none(cls, d: Transfer) -> Departure:
        """Return the start itself."""
        return cls(Fraction(0), d.attitude, Fraction(0), Fraction(0), "")

    @classmethod
    def read(cls, d: Transfer, gauge: Gauge, place: Node) -> Departure:
        """Read and prove a coast."""
        until, turn, slack = (place[name].number() for name in ("until", "turn", "slack"))
        require(0 < until <= d.window.knots[-1], "the coast must end within the transfer")
        attitude = place["attitude"].vector(4)
        require_turn(*coast_attitude(d.J, d.attitude, d.momentum, until), attitude, turn)
        gauge.require_rates_within(turn, slack)
        mu, nu = place["growth"].vector(2)
        require_growth(gauge, d.momentum, mu, nu)
        deviation = Fraction(0)
        for k in range(PEAK_COAST_CELLS):
            a, b = (until * (k + i) / PEAK_COAST_CELLS for i in (0, 1))
            factor = (exponential_above(mu * (until - a)) + exponential_above(nu * (until - a))) / 2
            deviation += d.window.moment(a, b, until) * factor
        words = f"after a coast of {show(until)} s, "
        return cls(until, attitude, deviation, slack, words)


def coast_attitude(J: Matrix, q: Vector, H: Vector, until: Fraction) -> tuple[Vector, Fraction]:
    """Quaternion after free motion from q with body momentum H, and a bound of the distance from it.

    In steps of the time x in [0, 1], with g = H/sigma and u = B g, B = sigma step J^-1,
        g' = g x u,        q' = q (0, u)/2,
    Taylor polynomials in units of 2^-PEAK_COAST_BITS, B too, however long its numbers are. What they miss
    of the equations (the products beyond their degree, and every rounding) is a defect; |g| and the length
    of a difference of quaternions are conserved, so the errors grow at most as
    e' <= |B| (|g| + |its polynomial|) e + defect and as |q's polynomial| |B| e/2 + defect.
    """
    one, inverse = 1 << PEAK_COAST_BITS, inverse_matrix(J)
    size = length_interval(H)[1]
    sigma = Fraction(2) ** _magnitude(size)
    fastest = root_interval(sum((x * x for row in inverse for x in row), Fraction(0)))[1]
    steps = math.ceil(8 * fastest * size * until)
    require(steps <= PEAK_COAST_STEPS, "the coast turns too far")
    require(1 < 2**64 * max(map(abs, q)) < 2**128, "the start quaternion is too long or too short")
    B = [[math.floor(x * sigma * until / steps * one) for x in row] for row in inverse]
    b, size = fastest * sigma * until / steps, size / sigma
    g, p = ([math.floor(x * one) for x in v] for v in ([h / sigma for h in H], q))
    off, error = Fraction(4, one), Fraction(4, one)
    for _ in range(steps):
        G, Q, U = coast_series(B, g, p)
        sizes = [[Fraction(sum(map(abs, c)), one) for c in v] for v in (G, Q, U)]
        reach, length = (sum(v, Fraction(0)) for v in sizes[:2])
        rounded = Fraction(4 * (PEAK_COAST_ORDER + 1) ** 2, one)
        grown = b * (size + reach)
        require(grown <= 1, "a step of the coast is too long")
        rounded *= 1 + reach  # the rounding of B grows with what it acts on
        off += rounded * (1 + reach) + beyond(sizes[0], sizes[2])
        off = rounded_up(off * (1 + grown + grown**2) * one) / one
        error += rounded * (1 + length) + beyond(sizes[1], sizes[2]) + length * b * off
        error = rounded_up(error * one) / one
        g, p = ([sum(c) for c in zip(*v, strict=True)] for v in (G, Q))
    return [Fraction(c, one) for c in p], error


def coast_series(B: list[list[int]], g: list[int], p: list[int]) -> tuple[list[list[int]], ...]:
    """Coefficients of g, q and u in powers of the time; each is off by at most one unit for its order."""
    G, Q, U = [g], [p], []
    for k in range(PEAK_COAST_ORDER + 1):
        U.append([sum(map(mul, row, G[k])) >> PEAK_COAST_BITS for row in B])
        if k == PEAK_COAST_ORDER:
            break
        pairs = [(i, k - i) for i in range(k + 1)]
        scale = (k + 1) << PEAK_COAST_BITS
        turns = [cross(G[i], U[j]) for i, j in pairs]
        moves = [quaternion_times(Q[i], [0, *U[j]]) for i, j in pairs]
        G.append([sum(c) // scale for c in zip(*turns, strict=True)])
        Q.append([sum(c) // (2 * scale) for c in zip(*moves, strict=True)])
    return G, Q, U


def beyond(x: Vector, y: Vector) -> Fraction:
    """Sum of x_i y_j over i + j >= the order: bound of what a product has beyond the series."""
    n = PEAK_COAST_ORDER
    return sum((a * sum(y[max(n - i, 0) :], Fraction(0)) for i, a in enumerate(x)), Fraction(0))


def require_turn(reached: Vector, radius: Fraction, q: Vector, turn: Fraction) -> None:
    """Prove that a rotation by at most `turn` joins q to whatever is within the radius of `reached`."""
    share = sum((a * b for a, b in zip(reached, q, strict=True)), Fraction(0))
    square = sum((c * c for c in q), Fraction(0))
    require(share > 0 and square > 0, "the attitude after the coast is not the one stated")
    off = [a - share / square * b for a, b in zip(reached, q, strict=True)]
    distance, length = length_interval(off)[1] + radius, length_interval(reached)[0] - radius
    # The arc is at most asin(distance/length) <= (pi/2) distance/length, the rotation twice that.
    sure = length > distance and Fraction(22, 7) * distance <= turn * length
    require(sure, "the attitude after the coast is not proved to be the one stated")


def require_growth(gauge: Gauge, H: Vector, mu: Fraction, nu: Fraction) -> None:
    """Prove mu and nu of `Departure`.

    A row's growth is y'M X y/(y'M y), X linear in h. Where N(y) = 1 by that row y'M y = L, and |y|^2 <= L_0:
    it is at most L_0/L times the largest eigenvalue of the symmetric part of M X.
    """
    require(mu >= 0 and nu >= 0, "growth must not be negative")
    unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
    require(gauge.rows[0] == unit and gauge.box is None, "the first row of the set must be the identity")
    stretch, turning = [], []
    for h in unit:
        w = image(gauge.inverse, h)
        moved = [image(gauge.inverse, y) for y in unit]
        held = [image(gauge.J, cross(w, c)) for c in moved]
        parted = [cross(h, c) for c in moved]
        stretch.append(
            [[x - y for x, y in zip(a, b, strict=True)] for a, b in zip(parted, held, strict=True)]
        )
        turning.append([cross(y, w) for y in unit])
    square = sum((x * x for x in H), Fraction(0))
    for M, L in zip(gauge.rows, gauge.levels, strict=True):
        for rate, X in ((mu, stretch), (nu, turning)):
            require_eigenvalues_within(M, X, square, rate * L / gauge.levels[0])


def require_eigenvalues_within(M: Matrix, X: list[Matrix], square: Fraction, bound: Fraction) -> None:
    """Prove that eigenvalues of S, the symmetric part of M sum h_i X_i, are <= bound for |h|^2 <= square.

    Each X is a list of columns. The trace of S is 0, so they are at most sqrt(2/3) |S|_F; and
    |S|_F^2 = h'G h with G_ij = tr S_i S_j.
    """
    parts: list[Vector] = []
    for columns in X:
        A = [image(M, c) for c in columns]
        S = [[(A[j][i] + A[i][j]) / 2 for j in range(3)] for i in range(3)]
        require(S[0][0] + S[1][1] + S[2][2] == 0, "a growth of volumes")
        parts.append([x for row in S for x in row])
    gram = [[sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0)) for q in parts] for p in parts]
    unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
    gap = combination([Fraction(3, 2) * bound**2, -square], [unit, gram])
    require(is_positive_semidefinite(gap), "the growth of a deviation is not proved")


def image(A: Matrix, x: Vector) -> Vector:
    """Return A x."""
    return [sum((a * b for a, b in zip(row, x, strict=True)), Fraction(0)) for row in A]


def exponential_above(x: Fraction) -> Fraction:
    """Upper bound of exp(x), x >= 0: the series at x/2^k <= 1/2, squared k times."""
    require(0 <= x <= 64, "the growth of a deviation is out of bounds")
    halvings = max(0, math.ceil(2 * x).bit_length())
    x = rounded_up(x / 2**halvings)
    value = term = Fraction(1)
    for k in range(1, 24):
        term = rounded_up(term * x / k)
        value += term
    value += term  # the rest is less than the last term
    for _ in range(halvings):
        value = rounded_up(value * value)
    return value


def require_travel(d: Transfer, gauge: Gauge, speed: Fraction, travel: Fraction, witness: Node) -> str:
    """Prove the travel to every quaternion of the target."""
    require(travel > 0 and speed > 0, "travel and speed must be positive")
    target, found = PeakTarget.of(d.tolerance), witness["separations"].items()
    require(len(found) == len(d.signs), "one separation for each target sign")
    words = []
    for sign, place in zip(d.signs, found, strict=True):
        q = [sign * c for c in d.attitude]
        words.append(require_separation(place, gauge, speed, q, target, travel))
    return f"travel at least {show(travel)} s in the gauge of {len(gauge.rows)} rows: " + "; ".join(words)


def require_components(d: Transfer, gauge: Gauge, peak: Fraction, witness: Node) -> str:
    """Travel of a cube of torques from rest to rest, each component of the momentum bounded by itself.

    Until the instant s let n = up, Y = int_0^t up^2; after it the same with time running backwards.
    K gives H in p n K, hence |H_i| <= r_i p n. Let B_i >= r_i, or 1 + kappa_i trial Y/up < B_i, where
    |(X x J^-1 X)_i| <= kappa_i for X in K, |X_j| <= B_j, |X_i| >= 1. For p <= trial then
    |H_i| <= p up + kappa_i p^2 Y: as long as every |H_j| <= B_j p n, |H_i| grows at most
    p w + kappa_i (p n)^2 wherever |H_i| >= p n; so |H_j| < B_j p n goes on, and it holds at first,
    because Y/up -> 0 where the windows first open. So at every instant H is in p n f times the part of
    K with |H_i| <= beta_i, f = max(1, max_i min(1 + kappa_i p Y/up, r_i)/beta_i).
    """
    require(d.words.startswith("every |torque_i(t)|"), "components are for the cube of torques")
    require(not any(d.rate) and d.end_rate == 0, "components are from rest to exact rest")
    travel, s, trial = (witness[name].number() for name in ("travel", "instant", "trial"))
    require(peak <= trial, "the peak is above the trial")
    r = [
        root_interval(gauge.largest(axis_matrix(i), row.vector()))[1]
        for i, row in enumerate(witness["widths"].items())
    ]
    B, box = witness["bounds"].vector(3), witness["box"].vector(3)
    require(len(r) == 3 and all(b >= 1 for b in B), "expected three widths, and bounds of at least 1")
    kappa = gyroscopic_bounds(gauge, B, witness["multipliers"])
    horizon = d.window.knots[-1]
    require(0 <= s <= horizon, "the instant must lie within the transfer")
    cells = [*d.window.cells(s), *d.window.mirrored().cells(horizon - s)]
    largest = max(ratio for _, ratio in cells)
    for width, bound, k in zip(r, B, kappa, strict=True):
        sure = bound >= width or 1 + k * trial * largest < bound
        require(sure, "a bound of a component is not proved")
    allowed = Fraction(0)
    for area, ratio in cells:
        grown = [min(1 + k * peak * ratio, x) / b for k, x, b in zip(kappa, r, box, strict=True)]
        allowed += peak * area * max(Fraction(1), *grown)
    require(allowed <= travel, "a transfer of that peak may travel enough")
    speed = gauge.speed(witness["speed"].vector())
    return require_travel(d, gauge.with_box(box), speed, travel, witness)


def gyroscopic_bounds(gauge: Gauge, B: Vector, place: Node) -> Vector:
    """kappa_i >= |(X x J^-1 X)_i| over X in K, |X_j| <= B_j, |X_i| >= 1: multipliers of both signs."""
    part, A = gauge.with_box(B), gauge.inverse
    lists = place.items()
    require(len(lists) == 6, "expected multipliers for three axes and two signs")
    kappa = [Fraction(0)] * 3
    for number, entry in enumerate(lists):
        i, sign = number // 2, 1 - 2 * (number % 2)
        j, k = (i + 1) % 3, (i + 2) % 3
        G = [[Fraction(0)] * 3 for _ in range(3)]
        for m in range(3):
            for row, column, value in ((j, m, A[k][m]), (k, m, -A[j][m])):
                G[row][column] += sign * value / 2
                G[column][row] += sign * value / 2
        *weights, floor = entry.vector()
        require(floor >= 0, "multipliers must not be negative")
        lifted = combination([Fraction(1), floor], [G, axis_matrix(i)])
        kappa[i] = max(kappa[i], part.largest(lifted, weights) - floor)
    return kappa


# --- command line ------------------------------------------------------------------------------


def printable(text: str) -> str:
    """Escape everything but plain characters: names come from the file, and must not pass for verdicts."""
    return "".join(c if " " <= c <= "~" else c.encode("unicode_escape").decode() for c in text)


def report(findings: list[Finding]) -> str:
    """Return the findings as text."""
    lines: list[str] = []
    for finding in findings:
        lines.append(f"{'VALID' if finding.valid else 'INVALID'}  {printable(finding.kind)}")
        lines += [f"    {printable(line)}" for line in finding.claim]
        if finding.reason:
            lines.append(f"    reason: {printable(finding.reason)}")
    good = sum(finding.valid for finding in findings)
    lines.append(f"{good} of {len(findings)} valid")
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str]) -> int:
    """Check the file named on the command line and return the exit code."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -I -S checker.py FILE\n")
        return 2
    try:
        text = Path(arguments[0]).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        sys.stderr.write(f"cannot read {arguments[0]}: {error}\n")
        return 2
    digits = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        findings = check_text(text)
        sys.stdout.write(report(findings))
    finally:
        sys.set_int_max_str_digits(digits)
    return 0 if all(finding.valid for finding in findings) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
