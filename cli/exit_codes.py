"""What the process's exit code says."""

from __future__ import annotations

from enum import IntEnum
from typing import final


@final
class ExitCode(IntEnum):
    """Exit codes of every command; where claims disagree, REFUTED wins over UNDECIDED."""

    HOLDS = 0
    REFUTED = 1
    BAD_INPUT = 2
    UNDECIDED = 3
    INTERNAL = 70
    INTERRUPTED = 130


HELP = (
    "Exit codes: 0 every counted claim holds, 1 one is refuted, 3 one is undecided, 2 bad input, "
    "70 internal error, 130 interrupted."
)
