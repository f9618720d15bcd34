"""The polynomials that a search starts from are those that the checker derives from the certificate."""

from fractions import Fraction as F

import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.verify import checker
from intermit.verify.certificates import as_text
from intermit.verify.exact.polynomial import NotPolynomialError, Ring
from intermit.verify.lyapunov import candidate
from intermit.verify.lyapunov.forms import inertia_data, law_form, parameter_data, storage_form
from intermit.verify.lyapunov.normal_form import decay_polynomials, on_sphere, vanishes
from problems import J1

LAWS = [
    AdaptiveScaling(lambda_=F(1), gamma=F(1, 2), R0=F(2), k0=F(0)),
    PersistenceFilter(lambda_=F(3, 4), R0=F(2)),
]


def _by_the_checker(chosen, weight):
    data = {**inertia_data(J1.exact_inertia, None), "law": law_form(chosen.loop)}
    data["parameters"] = parameter_data(chosen.loop)
    domain = "everywhere" if chosen.floor is None else "above floor"
    claim = {"storage": storage_form(chosen, weight=weight), "domain": domain}
    (found,) = checker.gaps(checker.Node(as_text(data), "data"), checker.Node(as_text(claim), "claim"))
    return found


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_both_derive_the_same_polynomials(law):
    chosen = candidate(close_loop(law))
    weight = F(1) if chosen.weight is not None else None
    gap, reference = _by_the_checker(chosen, weight)
    own = decay_polynomials(chosen, J1.exact_inertia, weight=weight)
    assert gap.terms
    assert (own[0].terms, own[1].terms) == (gap.terms, reference.terms)
    other = [
        [x + (F(1, 100) if i == j else 0) for j, x in enumerate(r)] for i, r in enumerate(J1.exact_inertia)
    ]
    assert decay_polynomials(chosen, other, weight=weight)[0].terms != gap.terms


def test_what_is_zero_on_the_sphere_alone_is_told_apart():
    loop = close_loop(LAWS[1])
    b0, bv = loop.plant.b0, loop.plant.bv
    length = b0**2 + bv[0] ** 2 + bv[1] ** 2 + bv[2] ** 2 - 1
    assert vanishes(loop, length, sphere=True)
    assert not vanishes(loop, length)
    assert not vanishes(loop, length + b0, sphere=True)


def test_division_stays_in_the_ring_or_is_refused():
    ring = Ring(["R", "c", "b1", "b2", "b3"], ["R"])
    R, b1 = ring.symbol("R"), ring.symbol("b1")
    assert (b1 / (R * R) * 2 + R).terms == {(-2, 0, 1, 0, 0): F(2), (1, 0, 0, 0, 0): F(1)}
    assert (b1 / R).substitute("R", R * 4) * R * 4 == b1
    assert (R + 1).moved([F(2), F(0), F(0), F(0), F(0)]) == R + 3
    assert on_sphere(ring.symbol("c") ** 2).coefficient((0, 1, 0, 0, 0)) == 2
    with pytest.raises(NotPolynomialError, match="not known to be positive"):
        R / b1
    with pytest.raises(NotPolynomialError, match="not a monomial"):
        R / (R + 1)
