"""A way in which a law can be proved: it reads the law's equations and returns a comparison system for them.

The package's own ways stand in `known_proofs` and are tried on every law; a law brings ways of its own by
returning them from `Law.proofs`. Either way what counts is the law's equations, never what it is called.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import casadi as ca

from ...models.closed_loop import ClosedLoop
from ...models.laws import Expression, Law
from .comparison import BodyBounds
from .law_system import LawSystem

CASCADE = (
    "any lambda > 0 suffices once inf R > 0: |Omega|_J decays as exp(-m/2) and the attitude follows, m "
    "the integral of g^2 kappa (1 + b0)"
)


class ComparisonProof(ABC):
    """A comparison theorem about a family of laws.

    Attributes
    ----------
    name : what messages call it
    """

    name: ClassVar[str]

    @abstractmethod
    def system(self, law: Law, bounds: BodyBounds) -> LawSystem:
        """Return the law's comparison system on bodies within these bounds.

        Raises
        ------
        NoComparisonError
            If the law's equations are not those of the theorem, with the equation that fails.
        """


def attitude_measures(loop: ClosedLoop) -> tuple[Expression, Expression]:
    """Return |Omega|_J = sqrt(Omega' J Omega) and sqrt(1 - b0) of a state."""
    Omega = loop.augmented_rate
    return ca.sqrt(ca.dot(Omega, loop.plant.J @ Omega)), ca.sqrt(1 - loop.plant.b0)
