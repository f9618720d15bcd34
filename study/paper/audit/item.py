"""One entry of the audit, and the exact tools its computations share."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, final

import casadi as ca

from ....models.closed_loop import ClosedLoop
from ....models.laws import Expression
from ....models.lowering import evaluate
from ....models.rigid_body import RigidBody
from ....verify.lyapunov import normal_form
from ....verify.lyapunov.exact_states import EXACT, ExactState, body_entries, loop_arguments, program_of
from ....verify.verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness

PAPER = "Ram & Akella, AAS 21-402"
J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
"""The paper's first inertia, kg m^2."""


@final
@dataclass(frozen=True)
class AuditItem:
    """One misprint of the paper.

    Attributes
    ----------
    number : "E1" to "E11"
    place : where it stands in the paper
    printed, corrected : both versions, in plain notation
    as_printed : the claim that the printed version is right; REFUTED by a witness
    as_corrected : the claim that the corrected version is right; PROVED
    consequences : what follows from the misprint
    figures : residuals and other numbers that show it
    """

    number: str
    place: str
    printed: str
    corrected: str
    as_printed: Claim
    as_corrected: Claim
    consequences: tuple[str, ...] = ()
    figures: tuple[Quantity, ...] = ()

    @property
    def is_demonstrated(self) -> bool:
        """Whether the printed version is refuted and the corrected one proved."""
        return (self.as_printed.verdict, self.as_corrected.verdict) == (Verdict.REFUTED, Verdict.PROVED)


def refuted(number: str, statement: str, witness: Witness) -> Claim:
    """Claim that the printed version is right, with the witness against it."""
    evidence = Evidence(EvidenceKind.WITNESS, "evaluated exactly", PAPER)
    return _claim(number, "printed", statement, Verdict.REFUTED, (evidence,), witness)


def proved(number: str, statement: str, how: str, details: Mapping[str, Any] | None = None) -> Claim:
    """Claim that the corrected version is right, by an exact computation already done."""
    evidence = Evidence(EvidenceKind.THEOREM, how, PAPER, dict(details or {}))
    return _claim(number, "corrected", statement, Verdict.PROVED, (evidence,), None)


def undecided(number: str, statement: str, reason: str) -> Claim:
    """Claim that a computation of the audit failed to decide: a mistake of this package."""
    return Claim(
        key=f"audit.{number}",
        title=f"{number}",
        statement=statement,
        verdict=Verdict.UNDECIDED,
        reason=reason,
        next_step="report this: the audit is meant to decide it",
        source=PAPER,
        counted=False,
    )


def _claim(
    number: str,
    version: str,
    statement: str,
    verdict: Verdict,
    evidence: tuple[Evidence, ...],
    witness: Witness | None,
) -> Claim:
    return Claim(
        key=f"audit.{number}.{version}",
        title=f"{number}, as {version}",
        statement=statement,
        verdict=verdict,
        evidence=evidence,
        witness=witness,
        source=PAPER,
        counted=False,
    )


def vanishes(loop: ClosedLoop, expression: Expression, extra: Mapping[str, Expression] | None = None) -> bool:
    """Whether an expression is identically zero on |beta| = 1, every parameter and inertia a symbol."""
    return normal_form.vanishes(loop, expression, extra, positive=(*loop.parameter_symbols, "R"), sphere=True)


def exact_values(
    loop: ClosedLoop,
    expression: Expression,
    state: ExactState,
    body: RigidBody,
    extra: Mapping[str, tuple[Expression, Fraction]] | None = None,
) -> list[Fraction]:
    """Elements of an expression at a rational state, exactly."""
    entries = body_entries(body.exact_inertia)
    pairs: Sequence[tuple[Expression, Fraction]] = list((extra or {}).values())
    program = program_of(loop, [symbol for symbol, _ in pairs], [ca.SX(expression)])
    arguments = [*loop_arguments(loop, state, entries), *([value] for _, value in pairs)]
    return evaluate(program, EXACT, arguments, Fraction)[0]


def tilted_state(**changes: Any) -> ExactState:
    """Return a state of round rational numbers, off every symmetry, with chosen entries changed."""
    F = Fraction
    state = ExactState(
        quaternion=(F(1, 2), F(1, 2), F(1, 2), F(1, 2)),
        rate=(F(1, 5), F(-1, 10), F(3, 10)),
        controller={"R": F(1, 2), "k": F(1, 4)},
        gain=F(1),
        gain_rate=F(1, 3),
    )
    return replace(state, **changes)
