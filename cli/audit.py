"""`intermit audit`."""

from __future__ import annotations

from .options import Debug, JsonFile


def run(json: JsonFile = None, debug: Debug = False) -> int:
    """Audit the paper's printed equations: each derived, or refuted with a counterexample.

    Exit code 0 if every misprint is shown (printed version refuted, corrected one proved), else 3.
    """
    del debug
    from ..study.paper.audit_record import audit_record, run_audit
    from .console import progress
    from .finish import finish

    with progress("audit") as step:
        study = run_audit(step)
    return finish(audit_record(study), json, failed=not study.is_complete)
