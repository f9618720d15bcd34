"""What a check found: every claim, and each law's run; printed, drawn, or as a table."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any, final

from ...errors import InputError
from ...reports.content.blocks import Axis, Chart
from ...reports.summary import Shown, Summary
from ...scenario import Scenario
from ...verify.claim_table import order_of
from ...verify.verdict import Claim, Verdict
from ..claims.counting import exit_code, sentence
from ..plots import TIME, components, draw, needed, windows_of
from ..simulation import Simulation
from .case import Case

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


@final
@dataclass(frozen=True, repr=False)
class CheckStudy(Shown):
    """Everything a check found.

    Attributes
    ----------
    claims : about the schedule, whatever the law
    cases : one for each law, in the scenario's order
    """

    scenario: Scenario
    claims: tuple[Claim, ...]
    cases: tuple[Case, ...]

    @property
    def all_claims(self) -> tuple[Claim, ...]:
        """Claims about the schedule, then those about each law."""
        return self.claims + tuple(claim for case in self.cases for claim in case.claims)

    @property
    def exit_code(self) -> int:
        """0, 1 or 3 by the counted claims."""
        return exit_code(self.all_claims)

    @property
    def sentence(self) -> str:
        """The outcome in one sentence."""
        return sentence(self.all_claims)

    def claim(self, key: str, law: str | None = None) -> Claim:
        """The claim of that key: about the schedule, or about a law by its label (the first without one).

        Raises
        ------
        InputError
            If there is none; the message names the keys there are.
        """
        chosen = [case.claims for case in self.cases if law in (None, case.choice.label)]
        among = (*self.claims, *(chosen[0] if chosen else ()))
        for found in among:
            if found.key == key:
                return found
        raise InputError(f"no claim {key!r}{f' of {law!r}' if law else ''} (there are {_keys(among)})")

    @property
    def summary(self) -> Summary:
        """The verdicts, one row a claim and one column a law, and why what is not proved is not."""
        return _summary(self)

    def plot(self) -> NDArray[np.object_]:
        """Draw the applied torque of every simulated law, N m over s; matplotlib axes, (number of laws,).

        Raises
        ------
        InputError
            If no law was simulated to the horizon.
        """
        runs = [
            Simulation(self.scenario, case.choice.label, case.run)
            for case in self.cases
            if case.run is not None and case.run.trajectory is not None
        ]
        if not runs:
            raise InputError("nothing to draw: no law was simulated to the horizon")
        shaded = windows_of(self.scenario.schedule, self.scenario.horizon)
        return draw(
            [
                Chart(
                    f"torque-{i}", run.label, TIME, Axis("g u", "N m"),
                    components(run.time, run.torque), "", shaded,
                )
                for i, run in enumerate(runs)
            ]
        )  # fmt: skip

    def to_dataframe(self) -> Any:
        """All claims as a pandas DataFrame: subject, key, verdict, statement, counted, reason.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        groups = [("schedule", self.claims), *((case.choice.label, case.claims) for case in self.cases)]
        rows = [
            {
                "subject": subject, "key": claim.key, "verdict": claim.verdict.value,
                "statement": claim.statement, "counted": claim.counted, "reason": claim.reason,
            }
            for subject, claims in groups
            for claim in claims
        ]  # fmt: skip
        return needed("pandas", "to_dataframe()").DataFrame(rows)


def _keys(claims: Iterable[Claim]) -> str:
    return ", ".join(claim.key for claim in claims)


def _summary(study: CheckStudy) -> Summary:
    """The verdicts of a check in a few lines."""
    titles = {claim.key: claim.title for claim in study.all_claims}
    laws = [case.choice.label for case in study.cases]
    about = [{claim.key: claim for claim in case.claims} for case in study.cases]
    schedule = [(claim.title, _verdict(claim)) for claim in study.claims]
    keys = sorted({key for claims in about for key in claims}, key=order_of)
    rows = [(titles[key], *(_verdict(claims.get(key)) for claims in about)) for key in keys]
    why = dict.fromkeys(_why(claim) for claim in study.all_claims if claim.verdict is not Verdict.PROVED)
    if any(not claim.counted for claim in study.all_claims):
        why["* reported; does not decide the exit code"] = None
    title = f"{study.scenario.name} ({study.scenario.path.name})"
    tables = ((("The schedule", "verdict"), schedule), (("The laws", *laws), rows))
    return Summary(title, (study.sentence, *why), tables)


def _why(claim: Claim) -> str:
    """Why a claim is not proved, in one line."""
    if claim.witness is not None:
        return f"{claim.key}: {claim.verdict.value}: {claim.witness.description}"
    return f"{claim.key}: {claim.reason}; next: {claim.next_step}"


def _verdict(claim: Claim | None) -> str:
    return "-" if claim is None else claim.verdict.value + ("" if claim.counted else " *")
