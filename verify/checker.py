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
    lam, a = data["parameters"]["lambda"].number(), certificate["claim"]["weight"].number()
    require(lam > 0 and a > 0, "lambda and the weight a must be positive")
    for J in inertia_vertices(data):
        gap = [[4 * lam**2 * J[i][j] - (a if i == j else 0) for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "4 lambda^2 J - a I is not positive semidefinite")
    return [
        f"lambda >= sqrt(a)/(2 sqrt(Jmin)) for lambda = {show(lam)} 1/s, a = {show(a)} kg m^2/s^2,",
        describe_inertia(data),
    ]


@kind("paper-condition")
def check_paper_condition(data: Node, certificate: Node) -> list[str]:
    """Decide lambda > max(1/(2 Jmin), 1/2), that is 2 lambda J - I > 0 and lambda > 1/2."""
    del certificate
    lam = data["parameters"]["lambda"].number()
    require(lam > Fraction(1, 2), "lambda must exceed 1/2")
    for J in inertia_vertices(data):
        gap = [[2 * lam * J[i][j] - (1 if i == j else 0) for j in range(3)] for i in range(3)]
        require(is_positive_definite(gap), "2 lambda J - I is not positive definite")
    return [f"lambda > max(1/(2 Jmin), 1/2) for lambda = {show(lam)} 1/s,", describe_inertia(data)]


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

    def uses(self, name: str) -> bool:
        """Whether a symbol occurs."""
        i = self.ring.index[name]
        return any(key[i] for key in self.terms)

    def text(self, limit: int = 40) -> str:
        """Return the polynomial for people, at most `limit` terms."""
        parts: list[str] = []
        for key, value in sorted(self.terms.items(), reverse=True)[:limit]:
            powers = [
                name + (f"^{e}" if e != 1 else "") for name, e in zip(self.ring.names, key, strict=True) if e
            ]
            factor = [] if abs(value) == 1 and powers else [show(abs(value))]
            parts.append(("- " if value < 0 else "+ ") + " ".join(factor + powers))
        if len(self.terms) > limit:
            parts.append(f"+ ... ({len(self.terms)} terms)")
        return " ".join(parts).removeprefix("+ ") or "0"


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
Triple = list[Poly]


def cross(x: Triple, y: Triple) -> Triple:
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


def _upper(J: Matrix | None, ring: Ring, symbols: dict[str, Poly]) -> list[Poly]:
    if J is None:
        return [symbols[name] for name in INERTIA]
    return [ring.constant(J[i][j]) for i in range(3) for j in range(i, 3)]


@dataclass(frozen=True)
class Derivative:
    """V and its derivative along the closed loop, the reference W, and the shift y - w."""

    value: Poly
    rate: Poly
    outputs: dict[str, Poly]
    shift: Triple


def differentiate(loop: Loop, law: Node, storage: Node) -> Derivative:
    """Derive V' from the law, the storage function and the equations of the rigid body.

    b0' = -bv.w/2, bv' = (b0 w + bv x w)/2, J w' = -w x J w + g u: these three lines are the
    checker's own.
    """
    ring, symbols = loop.ring, loop.symbols
    free = run(storage["shift_program"], ring, symbols)
    shift = [pick(free, place) for place in storage["shift"].items()]
    require(
        len(shift) == 3 and not any(p.uses("g_rate") for p in shift),
        "the shift must be three functions of state",
    )
    w = [ring.symbol(name) - shift[i] for i, name in enumerate(RATE)]
    known = {**symbols, **{f"w{i + 1}": w[i] for i in range(3)}}
    control = run(law["program"], ring, known)
    torque = [pick(control, place) for place in law["torque"].items()]
    require(len(torque) == 3, "the torque must have three components")
    b, b0 = [ring.symbol(name) for name in ATTITUDE], symbols["b0"]
    turn = cross(b, w)
    rates = {"c": total([b[i] * w[i] for i in range(3)], ring).scaled(Fraction(1, 2))}
    rates |= {ATTITUDE[i]: (b0 * w[i] + turn[i]).scaled(Fraction(1, 2)) for i in range(3)}
    rates |= {name: pick(control, law["rates"][name]) for name in loop.states}
    rates |= {name: symbols[f"{name}_rate"] for name in ("g", *loop.signals)}

    def along(p: Poly) -> Poly:
        return total([p.derivative(name) * rate for name, rate in rates.items() if p.uses(name)], ring)

    gyro = cross(w, apply(loop.J, w, ring))
    momentum = [symbols["g"] * torque[i] - gyro[i] for i in range(3)]
    shift_rate = apply(loop.J, [along(p) for p in shift], ring)
    momentum = [on_sphere(momentum[i] + shift_rate[i]) for i in range(3)]
    outputs = run(storage["program"], ring, known)
    value = on_sphere(pick(outputs, storage["value"]))
    require(not value.uses("g_rate"), "the storage function must not use g'")
    gradient = _momentum_gradient(loop, storage, outputs, [value.derivative(name) for name in RATE])
    rate = along(value) + total([gradient[i] * momentum[i] for i in range(3)], ring)
    return Derivative(value, on_sphere(rate), outputs, shift)


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
    numbers = [[entry.terms.get(loop.ring.one, Fraction(0)) for entry in row] for row in loop.J]
    require(all(len(entry.terms) <= 1 for row in loop.J for entry in row), "J has no inverse in symbols")
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


def describe_law(data: Node, *, symbolic: bool) -> str:
    """Return the law's name and parameters for people."""
    law = data["law"]
    names = [node.text() for node in law["parameters"].items()]
    if symbolic:
        return f"law {law['name'].text()}, every {', '.join(names)} > 0"
    values = [f"{name} = {show(data['parameters'][name].number())}" for name in names]
    return f"law {law['name'].text()}, {', '.join(values)}"


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
    return where + (f", 0 <= g <= {show(claim['gain_bound'].number())}" if claim.has("gain_bound") else "")


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
        if name == "k_target" or (name == "R" and not floor and "R" in ring.index):
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
