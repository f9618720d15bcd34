"""The end of a command whose result is a record: print its tables, write it if asked."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

from .collection_page import print_collections
from .console import output
from .exit_codes import ExitCode

if TYPE_CHECKING:
    from ..reports.record import Record


def finish(record: Record, json: Path | None, *, failed: bool = False) -> int:
    """Print, write, and give the exit code: 3 if what was asked for was not found."""
    print_collections(output(), record)
    if json is not None:
        from ..reports.record import write_record_to

        write_record_to(record, json)
    return ExitCode.UNDECIDED if failed else ExitCode.HOLDS
