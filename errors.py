"""The base of every error that the user can mend: bad input, said in one line."""

from __future__ import annotations


class InputError(ValueError):
    """What was given, or asked for, cannot be taken: one line that says where, what and what to do.

    Every error of the command line's exit code 2 that is not the operating system's derives from it:
    `ScenarioError` (a scenario's file and key), `RecordError` (a record's file), `FolderError` (a folder
    that would lose somebody's files).
    """
