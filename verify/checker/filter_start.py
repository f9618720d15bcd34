"""Kinds filter-start and filter-start-counterexample: R(0) and its bound."""

from __future__ import annotations

from fractions import Fraction

from .bernstein import Form, from_powers
from .exact_numbers import require, show
from .kinds import kind
from .reading import Node
from .schedules import Profile, describe_profile, read_profile


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
