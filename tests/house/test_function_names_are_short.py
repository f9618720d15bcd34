"""A function's name is read in one glance: under sixty characters, in tests as in the package."""

import ast
from pathlib import Path

LONGEST = 60


def test_function_names_are_under_sixty_characters():
    root = Path(__file__).resolve().parents[2]
    files = [p for p in root.rglob("*.py") if not {".venv", "build"} & set(p.relative_to(root).parts)]
    assert len(files) > 100
    names = [
        (path.name, node.name)
        for path in files
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8")))
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef))
    ]
    assert [pair for pair in names if len(pair[1]) >= LONGEST] == []
