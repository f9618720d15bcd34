"""The one exception a user's input can raise: a single line that names the file and the key."""

from __future__ import annotations

from typing import final

from ..errors import InputError

MAX_QUOTE = 60
"""Characters of a user's own text that an error message repeats."""


@final
class ScenarioError(InputError):
    """Bad input, said in one line: file, key (or CSV line), what was expected and received.

    Attributes
    ----------
    where : str
        File, and the key or CSV line in it.
    problem : str
        What is wrong there and what to do.
    """

    def __init__(self, where: str, problem: str) -> None:
        self.where = one_line(where)
        self.problem = one_line(problem)
        super().__init__(f"{self.where}: {self.problem}")

    def __reduce__(self) -> tuple[type[ScenarioError], tuple[str, str]]:
        """Let it come back whole from another process."""
        return ScenarioError, (self.where, self.problem)


def one_line(text: str) -> str:
    """Return the text with every control character and line break made visible."""
    return "".join(c if c.isprintable() else repr(c)[1:-1] for c in text)


def _spelled(value: object) -> str:
    """A value as TOML writes it."""
    if isinstance(value, (list, tuple)):
        return f"[{', '.join(map(_spelled, value))}]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_spelled(part)}" for key, part in value.items()) + " }"
    return str(value).lower() if isinstance(value, bool) else str(value)


def quote(value: object) -> str:
    """Return a user's own value as it is repeated in a message: one line, not endless."""
    text = _spelled(value)
    shown = one_line(text)
    if len(shown) > MAX_QUOTE:
        shown = shown[: MAX_QUOTE - 3] + "..."
    return f"'{shown}'" if isinstance(value, str) else shown
