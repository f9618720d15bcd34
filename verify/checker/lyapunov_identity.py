"""Kind lyapunov-identity: V' as a stated expression."""

from __future__ import annotations

from .closed_loop import read_loop
from .exact_numbers import require
from .kinds import kind
from .known_laws import describe_law
from .polynomials import on_sphere, pick
from .reading import Node
from .storage import differentiate


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
