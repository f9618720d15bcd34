"""What a comparison system is to the checker: bounds of a law's motion, and the inequalities that prove them.

A *component* is a function of time that bounds one quantity of the motion from below or above: y = |Omega|_J,
s = sqrt(1 - b0), the law's own states. A bound whose slope is on its safe side wherever the quantity touches
it, the others within their bounds, is never crossed (comparison theorem of Mueller and Walter). A system
states those slopes; each law's, and everything that is read off the bounds, stands in one file.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, TypeVar

from .bernstein import Form
from .exact_numbers import Invalid, Vector, require
from .floor_bounds import Box
from .reading import Node
from .schedules import Profile
from .tables import enter, entries

Bounds = dict[str, Fraction]
Conditions = Iterator[tuple[str, Form]]
ONE, TWO = Form.constant(1), Form.constant(2)
NO_BOUND = Fraction(3, 2)
System = TypeVar("System", bound="Comparison")


@dataclass(frozen=True)
class Setting:
    """What systems are checked against, whatever the law.

    Attributes
    ----------
    c : at least 1/sqrt(8 Jmin), proved for every inertia of the data
    greatest : at least Jmax, likewise
    profile : g(t)
    """

    c: Fraction
    greatest: Fraction
    profile: Profile

    @property
    def least(self) -> Fraction:
        """At most Jmin, kg m^2."""
        return 1 / (8 * self.c * self.c)


class Comparison(ABC):
    """The comparison system of one law; `read` proves that the law of the data is the one it is about.

    Attributes
    ----------
    name : what certificates call the system; it proves nothing
    states : names of the law's controller states
    sides, tail_sides : component -> -1 for a lower bound, +1 for an upper one; in a part that repeats too
    floor : the component that bounds the filter state R from below, or None
    decaying : components that may be scaled down together from period to period
    free : components that may end a period anywhere
    """

    name: ClassVar[str]
    states: ClassVar[tuple[str, ...]] = ()
    sides: ClassVar[Mapping[str, int]]
    floor: ClassVar[str | None] = None
    decaying: ClassVar[frozenset[str]] = frozenset()
    free: ClassVar[frozenset[str]] = frozenset()

    @property
    def tail_sides(self) -> Mapping[str, int]:
        """Components of a part that repeats."""
        return self.sides

    @classmethod
    @abstractmethod
    def read(cls, data: Node, setting: Setting) -> Comparison:
        """Return the system with the law's numbers, or raise Invalid with the equation that fails."""

    @classmethod
    def by_name(cls, data: Node, setting: Setting) -> Comparison:
        """Read a file of earlier versions, which calls the law by its name and holds no program."""
        del data, setting
        raise Invalid(f"the system {cls.name} reads the law's program, and there is none")

    @abstractmethod
    def start(self, s: Vector, y: Vector) -> Bounds:
        """Return what is known at t = 0 of a start with sqrt(1 - b0) and |Omega|_J in these intervals."""

    @abstractmethod
    def kappa(self) -> Fraction:
        """Return kappa(0), 1/s, of Omega = w + 2 g^2 kappa bv."""

    @abstractmethod
    def conditions(
        self, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: Sequence[str], *, tail: bool
    ) -> Conditions:
        """Name and polynomial of everything that must be >= 0 on a step; G is g^2, dx the slopes."""

    @abstractmethod
    def box(
        self, low: Bounds, high: Bounds, modes: Sequence[str], *, repeats: bool, limits: Bounds
    ) -> Mapping[str, Fraction]:
        """Read S, y, and kappa in [low, high] (and more, for `command`) off the components' extremes.

        Where the step repeats, S and y are scaled down from period to period: they must rest on components
        that are; `limits` bounds free components for all later time.
        """

    @abstractmethod
    def command(self, box: Box) -> Fraction:
        """Return a bound of the commanded torque |u|, N m, Euclidean."""

    @abstractmethod
    def words(self) -> list[str]:
        """Return the law for people, line by line: what was proved of the program."""

    def start_words(self) -> str:
        """Return the states' initial values for people."""
        return ""

    def limits(self, first: Bounds, last: Bounds, ratio: Fraction) -> Bounds:
        """Bounds over all later time of free components, from the start and the end of a period."""
        del first, last, ratio
        return {}

    def given_up(self, modes: Sequence[str]) -> frozenset[str]:
        """Components that a step with these forms holds over the first period only."""
        del modes
        return frozenset()


def initial_values(data: Node, states: Mapping[str, str]) -> Bounds:
    """Read the start of every state; `states` names the parameter that held it in earlier versions' files."""
    if data.has("initial"):
        require(set(data["initial"].keys()) == set(states), "expected the initial value of every state")
        return {name: data["initial"][name].number() for name in states}
    return {name: data["parameters"][old].number() for name, old in states.items()}


def angle_factor(S: Form) -> Form:
    """A(S) = 1 - S/4 - S^2/32, at least sqrt(1 - S/2) on 0 <= S <= 2: |s' + pull s| <= c A(S) y."""
    return ONE - S.times(Fraction(1, 4)) - (S * S).times(Fraction(1, 32))


TANGENTS = 64


def rate_factor(S: Form, modes: Sequence[str]) -> Form:
    """A(S), or the tangent that a step's third word names: sqrt(1 - S/2) <= (t^2 + 1 - S/2)/(2 t), t > 0."""
    if len(modes) < 3 or modes[2] == "A":
        return angle_factor(S)
    require(modes[2].isdecimal() and 1 <= int(modes[2]) <= TANGENTS, "unknown tangent of sqrt(1 - S/2)")
    t = Fraction(int(modes[2]), TANGENTS)
    return Form.constant((t * t + 1) / (2 * t)) - S.times(1 / (4 * t))


def comparison(system: type[System]) -> type[System]:
    """Enter a system into the table of the part that is read."""
    enter("systems", system.name, system)
    return system


@dataclass(frozen=True)
class Found:
    """A system that covers the law of the data, and the part it comes from (empty: the checker's own)."""

    system: Comparison
    part: str


def find_system(data: Node, witness: Node, setting: Setting) -> Found:
    """Return the system whose equations the law of the data has.

    The witness may say which one to try; what it says is no evidence, each reads the law's program.
    """
    asked = witness["system"].text() if witness.has("system") else ""
    known = [(name, system, part) for name, system, part in entries("systems") if not asked or name == asked]
    require(bool(known), f"this checker knows no comparison system {asked!r}: name its part with --with FILE")
    if not data["law"].has("program"):  # of earlier versions: the claim is about the equations printed
        law = data["law"]["name"].text()
        named = [(system, part) for name, system, part in known if name == law]
        require(bool(named), f"no comparison system is known for the law {law!r}")
        return Found(named[0][0].by_name(data, setting), named[0][1])
    states = tuple(node.text() for node in data["law"]["states"].items())
    reasons = []
    for _, system, part in known:
        if sorted(system.states) == sorted(states):
            try:
                return Found(system.read(data, setting), part)
            except Invalid as error:
                reasons.append(str(error))
    shapes = dict.fromkeys(" and ".join(system.states) or "none" for _, system, _ in known)
    raise Invalid(reasons[-1] if reasons else f"its controller states are not {', or '.join(shapes)}")
