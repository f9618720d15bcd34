"""The front door: everything the command line does, each as one call.

Every function takes a scenario as `load` returns it, or the path of its file. What is wrong with the
input raises `ScenarioError` with one line that names file and key. Nothing is printed or written
unless the name says so.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from ..scenario import Scenario, load_scenario

if TYPE_CHECKING:
    from ..optim.tuning.tune import Tuned
    from ..verify.checker import Finding
    from ..verify.verdict import Claim
    from .certify.run import Certification
    from .check.run import CheckStudy
    from .compare.run import Comparison
    from .optimum.run import OptimumStudy
    from .simulated_run import Run

Source = Scenario | str | Path


def load(path: str | Path) -> Scenario:
    """Read a scenario file (TOML; docs/scenario.md names every key); decimals stay exact.

    Raises
    ------
    ScenarioError
        One line that names the file and the key or CSV line.
    """
    return load_scenario(path)


def _scenario(source: Source) -> Scenario:
    return source if isinstance(source, Scenario) else load_scenario(source)


def check(source: Source, **options: Any) -> CheckStudy:
    """Decide every claim of a scenario: `.claims` about the schedule, `.cases` for each law, `.sentence`.

    Parameters
    ----------
    source : a scenario, or its file's path
    **options : of `CheckOptions`: simulate, margins, search (bool), workers (int)

    Returns
    -------
    CheckStudy
        Each claim has a `verdict` (PROVED, REFUTED, UNDECIDED), its `statement`, `evidence`, `quantities`.
    """
    from .check.run import CheckOptions, run_check

    return run_check(_scenario(source), CheckOptions(**options))


def simulate(source: Source, law: str | None = None) -> Run:
    """Simulate one law of a scenario (the first without a label) from its initial state to its horizon.

    Returns
    -------
    Run
        `.trajectory` with `state(t)` (n,) or (n, m): quaternion scalar first, rate rad/s, controller states;
        `signals(t)` with torques (3, m) N m; `.figures` with settling time (s), peaks (N m), impulse (N m s).

    Raises
    ------
    ScenarioError
        If there is no law, or none of that label.
    """
    from ..scenario import ScenarioError
    from .simulated_run import run_law

    scenario = _scenario(source)
    if not scenario.laws:
        raise ScenarioError(scenario.path.name, "has no [[law]] to simulate")
    choice = scenario.laws[0] if law is None else scenario.law(law)
    return run_law(scenario, choice.build())


def optimum(source: Source, **options: Any) -> OptimumStudy:
    """Find the least peak torque through the windows, with its certified lower bound.

    Parameters
    ----------
    source : a scenario, or its file's path
    **options : of `OptimumOptions`: norms ("component", "euclidean"), starts, seed, solver, mesh_gap, bound,
        least_time, least_impulse

    Returns
    -------
    OptimumStudy
        `.optima`, one a norm: `.answer.peak` (N m), `.answer.standing` (CHECKED, UNDECIDED), `.bound.value`.
    """
    from .optimum.run import OptimumOptions, run_optimum

    return run_optimum(_scenario(source), OptimumOptions(**options))


def bound(source: Source) -> Claim:
    """Bound the least peak torque of any controller from below, in the scenario's own norm: a claim."""
    from .optimum.lower_bounds import own_bound_claim

    return own_bound_claim(_scenario(source))


def compare(source: Source) -> Comparison:
    """Put every law beside the optimum for its own settling time: `.rows`, one a law."""
    from .compare.run import run_comparison

    return run_comparison(_scenario(source))


def tune(source: Source, **options: Any) -> Tuned:
    """Search a law's parameters for the least peak that settles in time.

    Parameters
    ----------
    source : a scenario, or its file's path
    **options : settle (s), norm, law (label), seed; the scenario's [tune] gives what is missing
    """
    from .tune.run import run_tuning

    return run_tuning(_scenario(source), **options)


def certify(source: Source, *, bound: bool = False) -> Certification:
    """Collect the certificates of a scenario's claims: `.claims`, and `.text` of a file for `recheck`.

    Parameters
    ----------
    source : a scenario, or its file's path
    bound : the lower bound of the least peak torque too
    """
    from ..models.types import silent
    from .certify.run import certify as run

    return run(_scenario(source), silent, bound=bound)


def recheck(text: str) -> list[Finding]:
    """Prove every claim of a certificate file's text anew, by the stand-alone checker.

    Returns
    -------
    list of Finding
        `.kind`, `.valid`, `.claim` (its words, line by line) and, if it is not valid, `.reason`.
    """
    from ..verify.checker import check_text

    return check_text(text)


def report(
    source: Source, folder: str | Path, *, author: str = "", date: str = "", force: bool = False
) -> Path:
    """Study a scenario and write its report (HTML, PDF, tables, figures, record) into a folder; return it.

    Parameters
    ----------
    source : a scenario, or its file's path
    folder : is made; `force` writes among files of another's making
    author, date : for the title page
    """
    from ..reports.build import write_report
    from .report.run import ReportOptions, run_report

    record = run_report(_scenario(source), ReportOptions(), date=date, author=author)
    return write_report(record, folder, force=force)
