"""Which proof covers a law: its own first, then the package's, each by the law's equations."""

from __future__ import annotations

from ...models.laws import Law
from .adaptive import AdaptiveProof
from .comparison import BodyBounds
from .law_system import LawSystem
from .persistence import PersistenceProof
from .proofs import ComparisonProof
from .recognise import NoComparisonError, has_resets, law_words
from .trial import require_sound

KNOWN_PROOFS: tuple[ComparisonProof, ...] = (PersistenceProof(), AdaptiveProof())
"""The package's proofs; a new one is one entry here."""


def system_of(law: Law, bounds: BodyBounds) -> LawSystem:
    """Return the comparison system of a law.

    A proof that the law brings itself is tried against the law's motion before it is used, and its
    certificates must be accepted by the checker's part that belongs to it (see `answer`).

    Raises
    ------
    NoComparisonError
        If no proof covers its equations, with the reason of the last one tried.
    """
    if has_resets(law):
        raise NoComparisonError(f"{law_words(law)} resets its states: no comparison theorem covers a jump")
    own = own_proofs(law)
    reasons = []
    for proof in (*own, *KNOWN_PROOFS):
        try:
            system = proof.system(law, bounds)
        except NoComparisonError as error:
            reasons.append(str(error))
            continue
        if any(proof is offered for offered in own):
            _require_part(law, system)
            require_sound(law, system, bounds)
        return system
    raise NoComparisonError((reasons[: len(own)] or reasons)[-1])


def _require_part(law: Law, system: LawSystem) -> None:
    """Refuse a law's own system that no part of the checker would prove again."""
    if not isinstance(system, LawSystem) or not system.system_name or system.part is None:
        kind = type(system).__name__
        raise NoComparisonError(
            f"the comparison system {kind} that {law_words(law)} brings has no part of the checker "
            "(system_name, part)"
        )


def own_proofs(law: Law) -> tuple[ComparisonProof, ...]:
    """Proofs that a law brings itself; what is none is left out."""
    found: object = law.proofs()  # a class of the user's may return anything
    offered = found if isinstance(found, (tuple, list)) else ()
    return tuple(proof for proof in offered if isinstance(proof, ComparisonProof))


def has_comparison(law: Law, bounds: BodyBounds) -> bool:
    """Whether a comparison theorem covers the law, by its equations."""
    try:
        system_of(law, bounds)
    except NoComparisonError:
        return False
    return True
