"""The certified lower bound of a scenario's least peak torque, as a claim with its certificate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

from ...models.norms import NORMS
from ...reports.content.blocks import Axis, Chart
from ...reports.summary import Shown, Summary
from ...scenario import Scenario
from ...verify.exact.rounding import digits_below
from ...verify.verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict
from ..plots import draw
from .nominal import nominal_words
from .run import norm_of, norms_asked, transfer

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ...optim.bounds import LowerBound
    from ...optim.problem import TransferProblem

SOURCE = "docs/lower-bounds.md"


def asks_for_optimum(scenario: Scenario) -> bool:
    """Whether the scenario says anything about its optimum."""
    return bool(scenario.optimum.model_fields_set)


@final
@dataclass(frozen=True, repr=False)
class CertifiedBound(Shown):
    """The lower bound of the least peak of any controller, in the scenario's own norm.

    Attributes
    ----------
    scenario : what is asked
    problem : the transfer: start, windows, final time, tolerances, norm
    bounds : every valid bound, with the argument it comes from
    claim : the largest bound that the stand-alone checker confirms, with its certificate
    """

    scenario: Scenario
    problem: TransferProblem
    bounds: LowerBound
    claim: Claim

    @property
    def value(self) -> float:
        """The claim's bound in `unit`, rounded down; 0 where none could be certified."""
        return self.claim.quantities[0].low if self.claim.quantities else 0.0

    @property
    def unit(self) -> str:
        """Unit of the bound: N m, or N for thrusters."""
        return self.problem.norm.unit

    @property
    def summary(self) -> Summary:
        """The claim, and every bound with its argument."""
        rows = [
            (bound.name, f"{below(bound.value)} {self.unit}") for bound in self.bounds.all if bound.value > 0
        ]
        claim = self.claim
        lines = (f"{claim.verdict.value}: {claim.title}", *(filter(None, (claim.reason, claim.next_step))))
        return Summary(self.scenario.name, lines, ((("Bound from", "certified >="), rows),))

    def plot(self) -> NDArray[np.object_]:
        """Draw what each argument gives, in `unit`; matplotlib axes, (1,)."""
        (axes,) = found = draw(
            [Chart("bounds", self.claim.title, Axis("bound", self.unit), Axis(""), (), "")]
        )
        names = [bound.name for bound in reversed(self.bounds.all)]
        axes.barh(names, [bound.value for bound in reversed(self.bounds.all)])
        return found


def own_bound(scenario: Scenario) -> CertifiedBound:
    """Bound the least peak in the scenario's own norm, with the certificate."""
    from ...optim.bounds import certified_lower_bound

    problem = transfer(scenario, norms_asked(scenario)[0])
    bounds = certified_lower_bound(problem)
    return CertifiedBound(scenario, problem, bounds, bound_claim(problem, bounds, nominal_words(scenario)))


def bound_claim(problem: TransferProblem, bound: LowerBound, nominal: str = "") -> Claim:
    """Claim the largest bound that the stand-alone checker confirms, and name a larger one without a file.

    `nominal`: which body it speaks of, in words (see `nominal_words`).
    """
    from ...optim.bounds.certificate import MAX_THRUSTERS, has_certificate, largest_certificate

    norm, unit = problem.norm.name, problem.norm.unit
    found = largest_certificate(problem, bound)
    if found is None:
        return Claim(
            "optimum.bound",
            f"least peak torque, {norm}: bounded from below",
            f"Some peak above 0 {unit} is needed for the transfer.",
            Verdict.UNDECIDED,
            reason="no bound above 0 was found: the start's momentum may carry the turn"
            if has_certificate(problem.norm) or not bound.value > 0
            else f"the bound {below(bound.value)} {unit} ({bound.name}) was found, but no certificate can "
            f"speak of {norm}",
            next_step="give a later start, or a start at rest"
            if has_certificate(problem.norm) or not bound.value > 0
            else f"limit the torque's length, its components, or at most {MAX_THRUSTERS} one-sided thrusters",
            source=SOURCE,
            counted=False,
        )
    named, certificate = found
    least, larger = f"{below(named.value)} {unit}", ""
    title = f"least peak torque, {norm}: at least {least} for any controller ({named.name})"
    if named.name != bound.name:
        title += f"; the larger bound by {bound.name} has no certificate"
        larger = f" The larger bound {below(bound.value)} {unit} ({bound.name}) has no certificate."
    spoken = f", {nominal}" if nominal else ""
    summary = "travel, multipliers and potentials, proved anew by the stand-alone checker"
    return Claim(
        "optimum.bound",
        title,
        f"No torque of peak below {least} ({norm}) makes the transfer{spoken}.{larger}",
        Verdict.PROVED,
        (Evidence(EvidenceKind.CERTIFICATE, summary, SOURCE, {"certificate": certificate}),),
        (Quantity("least_peak", named.value, float("inf"), unit, rigorous=True, side="lower"),),
        source=SOURCE,
        counted=False,
    )


def below(value: float) -> str:
    """Seven digits of a number > 0, rounded down."""
    return f"{digits_below(value, 7).normalize():g}"


def transfers_data(scenario: Scenario) -> list[object]:
    """The scenario's transfers in every norm, as certificates say them."""
    from ...optim.bounds.certificate import transfer_data

    norms = list(NORMS.values())
    if scenario.optimum.thrusters is not None:
        norms.append(norm_of(scenario, "thrusters"))
    return [transfer_data(transfer(scenario, norm))["transfer"] for norm in norms]
