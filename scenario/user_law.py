"""Loading a user's own law: a Python file and the class in it."""

from __future__ import annotations

import importlib.util
import sys
from hashlib import sha256
from pathlib import Path
from typing import TYPE_CHECKING

from .errors import ScenarioError, quote
from .files import read_text

if TYPE_CHECKING:
    from ..models.laws import Law


def load_law_class(path: Path, name: str, where: str) -> type[Law]:
    """Return the class `name` of the Python file `path`; the file's code is executed.

    Raises
    ------
    ScenarioError
        If the file cannot be read or run, has no such class, or the class is not a `Law`.
    """
    from ..models.laws import Law

    source = read_text(path, f"{where}.file: {path.name}")
    digest = sha256(f"{path.resolve()}\0{source}".encode()).hexdigest()[:16]
    module_name = f"_intermit_user_law_{digest}"
    module = sys.modules.get(module_name)
    if module is None:
        spec = importlib.util.spec_from_loader(module_name, loader=None, origin=str(path))
        assert spec is not None
        module = importlib.util.module_from_spec(spec)
        module.__file__ = str(path)
        sys.modules[module_name] = module
        try:
            exec(compile(source, str(path), "exec"), module.__dict__)  # noqa: S102  the user's own code, on request
        except Exception as error:
            del sys.modules[module_name]
            line = _line_of(error, path)
            raise ScenarioError(
                f"{where}.file: {path.name}{line}", f"cannot be run: {type(error).__name__}: {error}"
            ) from error
    found = getattr(module, name, None)
    if not isinstance(found, type):
        raise ScenarioError(f"{where}.class", f"{path.name} has no class {quote(name)}")
    if not issubclass(found, Law):
        raise ScenarioError(
            f"{where}.class",
            f"{quote(name)} must be a subclass of intermit.models.laws.Law (a frozen dataclass)",
        )
    return found


def _line_of(error: BaseException, path: Path) -> str:
    if isinstance(error, SyntaxError):
        return f" line {error.lineno}"
    line = ""
    traceback = error.__traceback__
    while traceback is not None:
        if traceback.tb_frame.f_code.co_filename == str(path):
            line = f" line {traceback.tb_lineno}"
        traceback = traceback.tb_next
    return line
