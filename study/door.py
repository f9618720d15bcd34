"""The front door: everything the command line does, each as one call.

Nothing is printed or written unless the name says so. Units are SI; quaternions are scalar first. What is
wrong with the input raises `InputError` with one line that names the file and key, or the option.
Every result prints what it found (`print`, notebooks) and, where there is something to see, has
`plot()`, which returns a numpy array of matplotlib axes.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, TypeVar, get_args

from ..errors import InputError
from ..scenario import Scenario, ScenarioError, load_scenario
from .options import CheckOptions, CompareOptions, NormKey, OptimumOptions, ReportOptions, SolverKey

if TYPE_CHECKING:
    from .certify.recheck import Rechecked
    from .certify.run import Certification
    from .check.result import CheckStudy
    from .compare.run import Comparison
    from .optimum.lower_bounds import CertifiedBound
    from .optimum.result import OptimumStudy
    from .simulation import Simulation
    from .tune.result import TuningStudy

T = TypeVar("T", bound=str)
Source = Scenario | Mapping[str, Any] | str | Path
"""A scenario as `load` returns it, or what `load` takes."""


def load(source: str | Path | Mapping[str, Any]) -> Scenario:
    """Read a scenario: a TOML file, or a mapping with the same tables and keys; decimals stay exact.

    Parameters
    ----------
    source : str, Path or mapping
        The file (docs/scenario.md names every key, with units), or its content as a mapping: floats mean
        their shortest decimal (0.1 is one tenth), numpy arrays are lists, and files that it names lie
        relative to the current folder.

    Returns
    -------
    Scenario
        `.body`, `.schedule`, `.initial`, `.initial_set`, `.laws`, `.horizon` (s), `.warnings`.

    Raises
    ------
    ScenarioError
        One line that names the file and the key or CSV line.
    """
    return load_scenario(source)


def check(
    source: Source, *, simulate: bool = True, margins: bool = True, search: bool = True, workers: int = 1
) -> CheckStudy:
    """Decide every claim of a scenario: about its schedule, then about each of its laws.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    simulate : bool
        Run every law from the initial state too.
    margins : bool
        Look for how far schedule and lambda may change before convergence is no longer certified.
    search : bool
        Look for the worst start by simulation.
    workers : int
        Processes, >= 1; the result does not depend on it.

    Returns
    -------
    CheckStudy
        `.sentence`, `.claims` (schedule), `.cases` (laws), `.claim(key, law)`: each claim has a `verdict`
        (PROVED, REFUTED, UNDECIDED), `statement`, `evidence`, `quantities`. `.plot()`: torques, N m.

    Raises
    ------
    InputError
        If the scenario asks for a claim that does not exist, a law cannot be built, or workers < 1.

    Notes
    -----
    What is proved, and how: docs/checks.md.
    """
    from .check.run import run_check

    _at_least("workers", workers, 1)
    options = CheckOptions(simulate=simulate, margins=margins, search=search, workers=workers)
    return run_check(_scenario(source), options)


def simulate(source: Source, law: str | None = None) -> Simulation:
    """Simulate one law of a scenario from its initial state to its horizon.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    law : str, optional
        Its label; the first law without one.

    Returns
    -------
    Simulation
        Histories over n instants: `.time` (n,) s, `.quaternion` (n, 4), `.rate` (n, 3) rad/s,
        `.torque` (n, 3) N m, `.controller`; `.figures` with settling time (s), peaks (N m), impulse (N m s);
        `.trajectory`, dense; `.plot()`, `.to_dataframe()`.

    Raises
    ------
    ScenarioError
        If there is no law, none of that label, or it cannot be built.
    """
    from .simulated_run import run_law
    from .simulation import Simulation

    scenario = _scenario(source)
    if not scenario.laws:
        raise ScenarioError(scenario.path.name, "has no [[law]] to simulate")
    choice = scenario.laws[0] if law is None else scenario.law(law)
    return Simulation(scenario, choice.label, run_law(scenario, choice.build()))


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
    """Find the least peak torque through the windows, beside its certified lower bound.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    norms : sequence of "component", "euclidean", "thrusters"
        Norms to solve in; none: both norms of the torque, or the thrusters if the scenario names some.
    starts : int, optional
        For each quaternion sign of the target, >= 1; the scenario's without one.
    seed : int, optional
        Of the first random start, >= 0; the scenario's without one.
    solver : "auto", "fast" or "reference"
        Convex programs, the nonlinear program (IPOPT), or the first with the second as fallback.
    mesh_gap : float
        Largest fraction of the peak that finer cells may still gain, > 0.
    bound : bool
        Certify a lower bound beside each optimum.
    least_time, least_impulse : bool
        Find the least transfer time (s), the least impulse (N m s), within the torque limit too.

    Returns
    -------
    OptimumStudy
        `.optima`, one a norm: `.answer.peak` (N m), `.answer.standing` (CHECKED, UNDECIDED, IMPOSSIBLE),
        `.answer.history.torque(t)` (..., 3) N m, `.bound.value`. `.plot()`: the torques.

    Raises
    ------
    InputError
        If an option is out of range, or thrusters or a limit are asked for and the scenario gives none.

    Notes
    -----
    The peak is the best of several starts, not proved least; the bound is proved: docs/optimum.md,
    docs/lower-bounds.md.
    """
    from .optimum.run import run_optimum

    for name, value, least in (("starts", starts, 1), ("seed", seed, 0)):
        if value is not None:
            _at_least(name, value, least)
    if not mesh_gap > 0:
        raise InputError(f"mesh_gap: expected a number > 0, received {mesh_gap!r}")
    options = OptimumOptions(
        norms=tuple(_one_of("norms", norm, get_args(NormKey)) for norm in norms),
        starts=starts,
        seed=seed,
        solver=_one_of("solver", solver, get_args(SolverKey)),
        mesh_gap=mesh_gap,
        bound=bound,
        least_time=least_time,
        least_impulse=least_impulse,
    )
    return run_optimum(_scenario(source), options)


def bound(source: Source) -> CertifiedBound:
    """Bound the least peak torque of any controller whatever from below, in the scenario's own norm.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.

    Returns
    -------
    CertifiedBound
        `.value` in `.unit` (N m, or N for thrusters), `.claim` with verdict and certificate, `.bounds`:
        what each argument gives. `.plot()`: the arguments side by side.

    Raises
    ------
    ScenarioError
        If the transfer cannot be stated: the message names the key.

    Notes
    -----
    Every bound is a theorem about every controller: docs/lower-bounds.md.
    """
    from .optimum.lower_bounds import own_bound

    return own_bound(_scenario(source))


def compare(source: Source, *, at_horizon: bool = False) -> Comparison:
    """Put every law beside the optimum and the certified bound for its own settling time.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    at_horizon : bool
        Compare a law that does not settle too, by how near it comes at the horizon.

    Returns
    -------
    Comparison
        `.rows`, one a law: `.run`, `.terms[norm]` with `.law_peak`, `.optimum`, `.bound` (N m).
        `.plot(norm)`: torques (N m) until each settles.

    Raises
    ------
    ScenarioError
        If a law cannot be built.
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
) -> TuningStudy:
    """Search a law's parameters for the least peak that settles in time, under certified conditions.

    What is None comes from the scenario's [tune].

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    settle : Fraction, float or str, optional
        Latest settling time, s, > 0: a text or fraction is exact, a float means its shortest decimal.
    norm : "component" or "euclidean", optional
        Of the peak that is made small.
    law : str, optional
        Label; the first law without one.
    seed : int, optional
        Of the search, >= 0.

    Returns
    -------
    TuningStudy
        `.law` (None if none was found), `.parameters` (exact), `.peak` (N m), `.settling` (s), `.history`.
        `.plot()`: the search.

    Raises
    ------
    InputError
        If a value cannot be taken, there is no such law, or no settling time.
    """
    from ..models.norms import NORMS
    from .tune.result import TuningStudy
    from .tune.run import run_tuning

    time = None if settle is None else _positive("settle", settle, "s")
    chosen = None if norm is None else NORMS[_one_of("norm", norm, tuple(NORMS))]
    if seed is not None:
        _at_least("seed", seed, 0)
    scenario = _scenario(source)
    return TuningStudy(scenario, run_tuning(scenario, settle=time, norm=chosen, law=law, seed=seed))


def certify(source: Source, *, bound: bool = False) -> Certification:
    """Collect the certificates of everything about a scenario that could be proved.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    bound : bool
        The lower bound of the least peak torque too, if the scenario has an [optimum] table.

    Returns
    -------
    Certification
        `.claims` of (subject, claim), `.certificates`, `.text` for `recheck`, `.write(path)`.

    Raises
    ------
    ScenarioError
        If a law cannot be built.
    """
    from ..models.types import silent
    from .certify.run import certify as run

    return run(_scenario(source), silent, bound=bound)


def recheck(source: str | Path | Certification, *, parts: Sequence[str | Path] = ()) -> Rechecked:
    """Prove every claim of a certificate file anew, by the stand-alone checker.

    Parameters
    ----------
    source : str, Path or Certification
        A Path is a file. A str is a file's text if it begins with "{", else a file.
    parts : sequence of str or Path
        Files of comparison systems of somebody else's, trusted beside the checker; their code is run.

    Returns
    -------
    Rechecked
        `.valid`; a sequence of findings: `.kind`, `.valid`, `.claim` (its words, line by line), `.reason`.

    Raises
    ------
    InputError
        If there is no such file, or it is not text.

    Notes
    -----
    What the checker trusts: verify/checker/README.md.
    """
    from .certify.recheck import recheck_text
    from .certify.run import Certification

    files = [Path(part) for part in parts]
    if isinstance(source, Certification):
        return recheck_text(source.text, files)
    if isinstance(source, str) and source.lstrip().startswith("{"):
        return recheck_text(source, files)
    try:
        return recheck_text(Path(source).read_text(encoding="utf-8"), files)
    except UnicodeDecodeError as error:
        raise InputError(f"{source}: is not UTF-8 text (byte {error.start + 1})") from None
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        raise InputError(f"{source}: cannot be read: {why}") from None


def report(
    source: Source,
    folder: str | Path,
    *,
    author: str = "",
    date: str = "",
    force: bool = False,
    optimum: bool = True,
    comparison: bool = True,
    margins: bool = True,
    front: bool = True,
    audit: bool = True,
    workers: int = 1,
) -> Path:
    """Study a scenario and write its report: HTML, PDF, tables, figures, and the record they are made from.

    Parameters
    ----------
    source : Scenario, mapping, str or Path
        A scenario, or what `load` takes.
    folder : str or Path
        Is made; what another program wrote there is not touched.
    author, date : str
        For the title page.
    force : bool
        Write among files of another's making.
    optimum, comparison, margins : bool
        Find the optimum; compare each law with its optimum; look for how far the schedule may change.
    front, audit : bool
        False leaves out what the scenario's [report] asks for.
    workers : int
        Processes, >= 1; the result does not depend on it.

    Returns
    -------
    Path
        The folder.

    Raises
    ------
    InputError
        If the scenario is wrong, the folder holds files of another's making, or workers < 1.
    """
    from ..reports.build import write_report
    from ..reports.folder import refuse
    from .report.run import run_report

    _at_least("workers", workers, 1)
    scenario = _scenario(source)
    refuse(folder, force=force)
    options = ReportOptions(
        optimum=optimum,
        comparison=comparison,
        front=front,
        audit=audit,
        check=CheckOptions(margins=margins, workers=workers),
    )
    record = run_report(scenario, options, date=date, author=author)
    return write_report(record, folder, force=force)


def _scenario(source: Source) -> Scenario:
    return source if isinstance(source, Scenario) else load_scenario(source)


def _at_least(name: str, value: int, least: int) -> None:
    """Refuse a whole number that is too small, or is none.

    Raises
    ------
    InputError
        Naming the option.
    """
    if isinstance(value, bool) or not isinstance(value, int) or value < least:
        raise InputError(f"{name}: expected a whole number >= {least}, received {value!r}")


def _one_of(name: str, value: T, words: Sequence[str]) -> T:
    """Refuse a word that is not among those an option takes.

    Raises
    ------
    InputError
        Naming the option and its words.
    """
    if value not in words:
        raise InputError(f"{name}: expected one of {', '.join(words)}, received {value!r}")
    return value


def _positive(name: str, value: Fraction | float | str, unit: str) -> Fraction:
    """Exact value > 0 of an option: a text or fraction as it is, a float by its shortest decimal.

    Raises
    ------
    InputError
        If it is no number, or not > 0.
    """
    try:
        exact = Fraction(value if isinstance(value, Fraction) else str(value).strip())
    except (ValueError, ZeroDivisionError, OverflowError):
        raise InputError(f"{name}: expected a number of {unit}, received {value!r}") from None
    if exact <= 0:
        raise InputError(f"{name}: expected a number > 0 {unit}, received {value!r}")
    return exact
