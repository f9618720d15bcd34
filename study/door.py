"""The front door: everything the command line does, each as one call.

Every function takes a scenario as `load` returns it, or the path of its file. What is wrong with the
input raises `ScenarioError` with one line that names file and key. Nothing is printed or written
unless the name says so.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Literal

from ..errors import InputError
from ..scenario import Scenario, load_scenario
from .options import CheckOptions, CompareOptions, NormKey, OptimumOptions, ReportOptions, SolverKey

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


def positive(name: str, value: Fraction | float | str, unit: str) -> Fraction:
    """Exact value > 0 of an option: a text or fraction as it is, a float by its shortest decimal.

    Raises
    ------
    InputError
        If it is no number, or not > 0.
    """
    try:
        exact = Fraction(value if isinstance(value, Fraction) else str(value).strip())
    except (ValueError, ZeroDivisionError):
        raise InputError(f"{name}: expected a number of {unit}, received {value!r}") from None
    if exact <= 0:
        raise InputError(f"{name}: expected a number > 0 {unit}, received {value!r}")
    return exact


def _scenario(source: Source) -> Scenario:
    return source if isinstance(source, Scenario) else load_scenario(source)


def check(
    source: Source, *, simulate: bool = True, margins: bool = True, search: bool = True, workers: int = 1
) -> CheckStudy:
    """Decide every claim of a scenario: `.claims` about the schedule, `.cases` for each law, `.sentence`.

    Parameters
    ----------
    source : a scenario, or its file's path
    simulate : run every law from the initial state too
    margins : look for how far schedule and lambda may change before convergence is no longer certified
    search : look for the worst start by simulation
    workers : processes, >= 1; the result does not depend on it

    Returns
    -------
    CheckStudy
        Each claim has a `verdict` (PROVED, REFUTED, UNDECIDED), its `statement`, `evidence`, `quantities`.

    Raises
    ------
    ScenarioError
        If the scenario asks for a claim that does not exist, or a law cannot be built.
    """
    from .check.run import run_check

    options = CheckOptions(simulate=simulate, margins=margins, search=search, workers=workers)
    return run_check(_scenario(source), options)


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


def optimum(
    source: Source,
    *,
    norms: Sequence[NormKey] = (),
    starts: int | None = None,
    seed: int | None = None,
    solver: SolverKey = "auto",
    mesh_gap: float = 1e-6,
    bound: bool = True,
    least_time: bool = False,
    least_impulse: bool = False,
) -> OptimumStudy:
    """Find the least peak torque through the windows, with its certified lower bound.

    Parameters
    ----------
    source : a scenario, or its file's path
    norms : "component", "euclidean", "thrusters"; none for both torques, or the thrusters if it names some
    starts : for each quaternion sign of the target, >= 1; None for the scenario's
    seed : of the first random start, >= 0; None for the scenario's
    solver : "fast" (convex programs), "reference" (nonlinear program), "auto" (the first, then the second)
    mesh_gap : largest fraction of the peak that finer cells may still gain
    bound : certify a lower bound beside each optimum
    least_time, least_impulse : find the least transfer time, s, the least impulse, N m s, within the torque
        limit too

    Returns
    -------
    OptimumStudy
        `.optima`, one a norm: `.answer.peak` (N m), `.answer.standing` (CHECKED, UNDECIDED), `.bound.value`.

    Raises
    ------
    ScenarioError
        If thrusters or a limit are asked for and the scenario gives none.
    """
    from .optimum.run import run_optimum

    options = OptimumOptions(
        norms=tuple(norms),
        starts=starts,
        seed=seed,
        solver=solver,
        mesh_gap=mesh_gap,
        bound=bound,
        least_time=least_time,
        least_impulse=least_impulse,
    )
    return run_optimum(_scenario(source), options)


def bound(source: Source) -> Claim:
    """Bound the least peak torque of any controller from below, in the scenario's own norm: a claim."""
    from .optimum.lower_bounds import own_bound_claim

    return own_bound_claim(_scenario(source))


def compare(source: Source, *, at_horizon: bool = False) -> Comparison:
    """Put every law beside the optimum for its own settling time: `.rows`, one a law.

    Parameters
    ----------
    source : a scenario, or its file's path
    at_horizon : compare a law that does not settle too, by how near it comes at the horizon
    """
    from .compare.run import run_comparison

    return run_comparison(_scenario(source), CompareOptions(at_horizon=at_horizon))


def tune(
    source: Source,
    *,
    settle: Fraction | float | str | None = None,
    norm: Literal["component", "euclidean"] | None = None,
    law: str | None = None,
    seed: int | None = None,
) -> Tuned:
    """Search a law's parameters for the least peak that settles in time.

    Parameters
    ----------
    source : a scenario, or its file's path
    settle : latest settling time, s, > 0: a text or fraction is exact, a float means its shortest decimal
    norm : of the peak that is made small
    law : label; the first law without one
    seed : of the search, >= 0

    What is None comes from the scenario's [tune].

    Raises
    ------
    InputError
        If a value cannot be taken, there is no such law, or no settling time.
    """
    from .tune.run import run_tuning

    time = None if settle is None else positive("settle", settle, "s")
    return run_tuning(_scenario(source), settle=time, norm=norm, law=law, seed=seed)


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
    from .report.run import run_report

    record = run_report(_scenario(source), ReportOptions(), date=date, author=author)
    return write_report(record, folder, force=force)
