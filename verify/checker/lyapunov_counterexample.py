"""Kind lyapunov-counterexample: a state at which V' > 0."""

from __future__ import annotations

from fractions import Fraction

from .body import read_inertia
from .closed_loop import ATTITUDE, RATE, read_loop
from .exact_numbers import Matrix, require, show
from .kinds import kind
from .known_laws import describe_law
from .lyapunov_derivative import read_domain
from .matrices import is_positive_definite, show_matrix
from .reading import Node
from .storage import differentiate


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
    least = 1 / values["k_target"] if read_domain(loop, claim) else Fraction(0)
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
