"""Laws by their equations: which of the known laws a program is, whatever the file calls it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction

from .closed_loop import ATTITUDE, RATE, Loop, Motion, along, law_values, move, read_loop
from .exact_numbers import HALF, require, show
from .polynomials import Poly, Triple, apply, cross, on_sphere, total
from .reading import Node

# A name in the file proves nothing. Names of the laws below may stand there only beside a program that
# has their equations. What is printed is the name of the known law that a program is, else its equations.

# Variables: S = 1 - b0, s = sqrt(S), y = |Omega|_J, Omega = w + 2 g^2 kappa bv. Along the closed loop
#   y' = -(1/2) g^2 kappa (2 - S) y,    |s' + (1/2) g^2 kappa s (2 - S)| <= c A(S) y,
#   R' = -lambda R + g^2 (2 - S),       k' = gamma R g^2 (2 - S)(y^2 + 2 a S),
# A(S) = 1 - S/4 - S^2/32 >= sqrt(1 - S/2), c >= 1/sqrt(8 Jmin). A bound whose slope is on its safe
# side wherever the component touches it, the others within their bounds, is never crossed.


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

FAMILY = "whose torque gives J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega,"


@dataclass(frozen=True)
class Scaled:
    """A law of the family, proved for every inertia; lam is lambda, a number in its equations."""

    loop: Loop
    motion: Motion
    lam: Fraction


def read_scaled(data: Node) -> Scaled:
    """Return the law of the data, whose states are R, or R and k, with the family's torque and filter."""
    law = data["law"]
    loop = read_loop(data, Node({}, "storage"), symbolic=False, J=None)
    kappa, ring = gain_of(loop), loop.ring
    true_name(loop, law)
    motion = move(loop, law, augmented(loop, kappa))
    words = "k" if "k" in loop.states else "1/R"
    for p in excess(loop, motion, kappa):
        require(
            not p.terms,
            f"its torque does not give J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega for "
            f"Omega = w + 2 g^2 kappa bv, kappa = {words}",
        )
    rest = on_sphere(motion.rates["R"] - filter_slope(loop, ring.constant(0)))
    lam = -rest.terms.get(next(iter(ring.symbol("R").terms)), Fraction(0))
    same = not (rest + ring.symbol("R").scaled(lam)).terms
    require(same and lam > 0, "its state R does not obey R' = -lambda R + g^2 (1 + b0) with lambda > 0")
    return Scaled(loop, motion, lam)


def gain_numbers(scaled: Scaled) -> tuple[Fraction, Fraction]:
    """Return gamma and a of the law's state k, whose rate is proved to be the adaptive one."""
    loop = scaled.loop
    zero, one = loop.ring.constant(0), loop.ring.constant(1)
    slope = on_sphere(scaled.motion.rates["k"])
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
    return gamma, a


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
