"""Kind lyapunov-derivative: the sign of V' by sums of squares."""

from __future__ import annotations

from collections.abc import Iterator

from .body import describe_inertia, inertia_vertices, read_inertia
from .closed_loop import INERTIA, Loop, read_loop
from .exact_numbers import Invalid, Matrix, require, show
from .kinds import kind
from .known_laws import describe_law
from .matrices import is_positive_semidefinite
from .polynomials import MAX_BASIS, Poly, Ring, on_sphere, pick, total
from .reading import Node
from .storage import differentiate


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
    if read_domain(loop, claim):
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


def read_domain(loop: Loop, claim: Node) -> bool:
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
