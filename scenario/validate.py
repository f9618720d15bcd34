"""Run the schema over a document and turn its first complaint into one line."""

from __future__ import annotations

from difflib import get_close_matches
from typing import Any

from pydantic import ValidationError

from .document import Document
from .errors import ScenarioError, quote
from .schema import ScenarioFile
from .table import Table
from .units import OF_KEYS, bare_key


def validate(document: Document) -> ScenarioFile:
    """Return the typed file.

    Raises
    ------
    ScenarioError
        For the first key that is unknown, missing or of the wrong kind.
    """
    try:
        return ScenarioFile.model_validate(document.tables)
    except ValidationError as error:
        problems = error.errors(include_url=False)
        first = problems[0]
        location = tuple(part for part in first["loc"] if not _is_tag(part))
        key = key_text(location)
        more = len({p["loc"][: len(first["loc"])] for p in problems}) - 1
        suffix = f" (and {more} more problem{'s' if more > 1 else ''})" if more else ""
        raise ScenarioError(document.where(key), _sentence(dict(first), location) + suffix) from None


def key_text(location: tuple[int | str, ...]) -> str:
    """Return a key as the user would write it; entries of lists are counted from 1."""
    text = ""
    for part in location:
        if isinstance(part, int):
            text += f"[{part + 1}]"
        else:
            text += f".{part}" if text else part
    return text


def _is_tag(part: int | str) -> bool:
    """Whether pydantic added this part itself (the branch of a union or a function's name)."""
    return isinstance(part, str) and any(c in part for c in "[](),")


def _sentence(problem: dict[str, Any], location: tuple[int | str, ...]) -> str:
    kind = problem["type"]
    if kind == "extra_forbidden":
        return "unknown key" + _suggestion(location)
    if kind == "missing":
        return "required, but missing"
    if kind == "value_error":
        key = next((part for part in reversed(location) if isinstance(part, str)), "")
        alone = isinstance(problem["input"], str) and key in OF_KEYS
        return str(problem["ctx"]["error"]) + (f": write it alone, in {OF_KEYS[key]}" if alone else "")
    if kind in {"tuple_type", "list_type"}:
        return f"expected a list, received {quote(problem['input'])}"
    if kind in {"model_type", "dict_type", "model_attributes_type"}:
        return f"expected a table, received {quote(problem['input'])}"
    if kind in {"too_long", "too_short"}:
        context = problem["ctx"]
        wanted = context.get("max_length", context.get("min_length"))
        return f"expected {wanted} entries, received {context['actual_length']}"
    if kind == "literal_error":
        wanted = problem["ctx"]["expected"].replace("'", '"')
        return f"expected {wanted}, received {quote(problem['input'])}"
    if kind.startswith("bool"):
        return f"expected true or false, received {quote(problem['input'])}"
    return f"{problem['msg']}, received {quote(problem['input'])}"


def _suggestion(location: tuple[int | str, ...]) -> str:
    """Return the nearest key that exists in the same table, if one is near."""
    model: Any = ScenarioFile
    for part in location[:-1]:
        if isinstance(part, int):
            continue
        field = next((f for n, f in model.model_fields.items() if (f.alias or n) == part), None)
        if field is None:
            return ""
        model = table_of(field.annotation)
        if model is None:
            return ""
    known = [field.alias or name for name, field in model.model_fields.items()]
    wanted = str(location[-1])
    base = bare_key(wanted)
    near = [name for name in (base, f"{base}_deg") if base != wanted and name in known]
    bare = {bare_key(name): name for name in known}
    near = near or [bare[name] for name in get_close_matches(base, bare, n=1)]
    if not near:
        return f" (known: {', '.join(known)})"
    unit = f", in {OF_KEYS[near[0]]}" if near[0] in OF_KEYS else ""
    return f" (did you mean '{near[0]}'{unit}?)"


def table_of(annotation: Any) -> type[Table] | None:
    """Return the table that a field holds, alone or in a list, if it holds one."""
    if isinstance(annotation, type) and issubclass(annotation, Table):
        return annotation
    for inner in getattr(annotation, "__args__", ()):
        found = table_of(inner)
        if found is not None:
            return found
    return None
