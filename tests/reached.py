"""Which functions the tests reached, of the rooms that claims rest on: a mark a call costs next to nothing.

With INTERMIT_REACHED=FOLDER the modules of these rooms are compiled with a mark at the start of every
function. Each test process leaves a file in the folder; `python tests/reached.py FOLDER` joins them and
fails if a function was reached by no test. (A line tracer would double the time of the proofs.)
"""

from __future__ import annotations

import ast
import importlib.abc
import importlib.machinery
import json
import os
import sys
from pathlib import Path
from types import CodeType, ModuleType

ROOMS = ("intermit.verify", "intermit.optim.bounds")
ALLOWED = {
    "intermit.verify.checker.__main__:run": "runs as a program of its own",
    "intermit.verify.checker.comparison:Comparison.by_name": "refuses; the built-in systems override it",
}
"""Functions that no test reaches in its own process, with the reason."""

_tables: dict[str, bytearray] = {}
_names: dict[str, list[str]] = {}


def functions(tree: ast.Module) -> list[tuple[str, ast.FunctionDef]]:
    """Functions and methods of a module by qualified name; not those that only state an interface."""
    found = []
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found.append((node.name, node))
        elif isinstance(node, ast.ClassDef):
            inner = (n for n in node.body if isinstance(n, ast.FunctionDef))
            found += [(f"{node.name}.{n.name}", n) for n in inner]
    return [(name, node) for name, node in found if not _is_interface(node)]


def _is_interface(node: ast.FunctionDef) -> bool:
    body = node.body[1:] if ast.get_docstring(node) is not None else node.body
    decorators = {getattr(d, "id", getattr(d, "attr", "")) for d in node.decorator_list}
    empty = all(isinstance(n, ast.Pass) or _is_ellipsis(n) for n in body)
    return empty or bool(decorators & {"abstractmethod", "overload"})


def _is_ellipsis(node: ast.stmt) -> bool:
    return isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant) and node.value.value is ...


def marked(source: str, path: str, module: str) -> CodeType:
    """Compile a module so that each of its functions says that it was called."""
    tree = ast.parse(source, path)
    listed = functions(tree)
    for number, (_, node) in enumerate(listed):
        mark = ast.parse(f"__reached__[{number}] = 1").body[0]
        place = 1 if ast.get_docstring(node, clean=False) is not None else 0
        node.body.insert(place, _at(mark, node))
    if listed:
        start = ast.parse("__reached__ = __import__('reached').table(__name__)").body[0]
        first = 1 if ast.get_docstring(tree, clean=False) is not None else 0
        while isinstance(head := tree.body[first], ast.ImportFrom) and head.module == "__future__":
            first += 1
        tree.body.insert(first, _at(start, tree.body[first]))
    _tables[module], _names[module] = bytearray(len(listed)), [name for name, _ in listed]
    return compile(ast.fix_missing_locations(tree), path, "exec", dont_inherit=True)


def _at(statement: ast.stmt, place: ast.stmt) -> ast.stmt:
    for node in ast.walk(statement):
        ast.copy_location(node, place)
    return statement


def table(module: str) -> bytearray:
    """Marks of a module, one a function."""
    return _tables[module]


class _Loader(importlib.machinery.SourceFileLoader):
    def get_code(self, fullname: str) -> CodeType:
        path = self.get_filename(fullname)
        return marked(self.get_data(path).decode(), path, fullname)


class _Finder(importlib.abc.MetaPathFinder):
    def find_spec(self, fullname: str, path: object, target: ModuleType | None = None):
        if not fullname.startswith(tuple(f"{room}." for room in ROOMS)) and fullname not in ROOMS:
            return None
        spec = importlib.machinery.PathFinder.find_spec(fullname, path)
        if spec is not None and spec.origin and spec.origin.endswith(".py"):
            spec.loader = _Loader(fullname, spec.origin)
        return spec


def install() -> None:
    """Mark every module of the rooms that is imported from now on."""
    early = [name for name in sys.modules if name.startswith(ROOMS)]
    if early:
        raise RuntimeError(f"imported before it could be marked: {', '.join(early)}")
    sys.meta_path.insert(0, _Finder())


def write(folder: Path) -> None:
    """Leave what this process reached."""
    folder.mkdir(parents=True, exist_ok=True)
    found = {
        module: [name for name, mark in zip(_names[module], marks, strict=True) if mark]
        for module, marks in _tables.items()
    }
    (folder / f"{os.getpid()}.json").write_text(json.dumps(found))


def unreached(folder: Path, package: Path) -> list[str]:
    """Functions of the rooms that no process reached."""
    held = [json.loads(file.read_text()) for file in sorted(folder.glob("*.json"))]
    missing = []
    for room in ROOMS:
        for file in sorted((package / Path(*room.split(".")[1:])).rglob("*.py")):
            parts = file.relative_to(package).with_suffix("").parts
            module = ".".join(("intermit", *(p for p in parts if p != "__init__")))
            reached = {name for one in held for name in one.get(module, ())}
            listed = (name for name, _ in functions(ast.parse(file.read_text())))
            missing += [f"{module}:{name}" for name in listed if name not in reached]
    return missing


def main(folder: str) -> int:
    """Say which functions no test reached; 1 if there are any that need to be."""
    missing = unreached(Path(folder), Path(__file__).resolve().parents[1])
    for name in missing:
        if name not in ALLOWED:
            print(f"reached by no test: {name}")  # noqa: T201
    for name in ALLOWED:
        if name not in missing:
            print(f"reached after all: take {name} off ALLOWED in {__file__}")  # noqa: T201
    return int(not set(missing) <= set(ALLOWED))


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
