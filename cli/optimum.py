"""`intermit optimum`."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated, get_args

import typer

from ..errors import InputError
from ..study.options import NormKey, OptimumOptions, SolverKey, help_of
from .options import Debug, JsonFile, ScenarioFile


def run(
    scenario: ScenarioFile,
    json: JsonFile = None,
    norm: Annotated[
        list[str] | None,
        typer.Option("--norm", help=help_of(OptimumOptions, "norms")),
    ] = None,
    starts: Annotated[
        int | None, typer.Option("--starts", min=1, help=help_of(OptimumOptions, "starts"))
    ] = None,
    seed: Annotated[int | None, typer.Option("--seed", min=0, help=help_of(OptimumOptions, "seed"))] = None,
    solver: Annotated[
        SolverKey,
        typer.Option("--solver", help=help_of(OptimumOptions, "solver")),
    ] = "auto",
    bound: Annotated[bool, typer.Option("--bound/--no-bound", help=help_of(OptimumOptions, "bound"))] = True,
    least_time: Annotated[
        bool, typer.Option("--least-time", help=help_of(OptimumOptions, "least_time"))
    ] = False,
    least_impulse: Annotated[
        bool, typer.Option("--least-impulse", help=help_of(OptimumOptions, "least_impulse"))
    ] = False,
    certificate: Annotated[
        Path | None,
        typer.Option("--certificate", metavar="FILE", help="Write the bounds' certificates, for recheck."),
    ] = None,
    debug: Debug = False,
) -> int:
    """Find the least peak torque any controller could do with through the windows."""
    del debug
    from ..study.optimum.run import norms_asked, run_optimum
    from .console import note, output, printing_what_is_found, progress
    from .opening import open_scenario
    from .optimum_page import print_optimum
    from .size import optimum_size, state_size

    began = perf_counter()
    loaded = open_scenario(scenario, says_clock=True)
    norms = tuple(key for key in get_args(NormKey) if key in (norm or ()))
    for key in norm or ():
        if key not in norms:
            raise InputError(f"--norm {key}: expected component, euclidean or thrusters")
    options = OptimumOptions(
        norms=norms,
        starts=starts,
        seed=seed,
        solver=solver,
        bound=bound,
        least_time=least_time,
        least_impulse=least_impulse,
    )
    state_size(optimum_size(loaded, len(norms_asked(loaded, options)), starts))
    with (
        printing_what_is_found(lambda found: print_optimum(output(), found)),
        progress(loaded.name) as step,
    ):
        study = run_optimum(loaded, options, step)
    print_optimum(output(), study)
    if certificate is not None:
        from ..reports.whole_files import write_whole
        from ..study.optimum.lower_bounds import bound_claim
        from ..study.optimum.nominal import nominal_words
        from ..verify.certificates import certificate_text
        from ..verify.lyapunov import certificates_of

        body = nominal_words(loaded)
        claims = [
            bound_claim(o.stated or o.problem, o.bound, body) for o in study.optima if o.bound is not None
        ]
        held = certificates_of(claims)
        for claim in claims:
            note(f"{claim.verdict.value} {claim.title}")
        if held:
            write_whole(certificate, certificate_text(held))
            note(
                f"{len(held)} certificates in {certificate}: intermit recheck {certificate} proves them anew"
            )
        else:
            note("no bound could be certified: no file written")
    if json is not None:
        from ..reports.record import write_record_to
        from ..study.optimum.record import optimum_record

        write_record_to(optimum_record(study), json)
    note(f"{perf_counter() - began:.1f} s")
    return study.exit_code
