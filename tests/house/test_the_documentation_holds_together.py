"""Links lead somewhere, every page is in the index, and every term of the glossary names what exists."""

from __future__ import annotations

import re
from importlib import import_module
from pathlib import Path

import pytest


def pages(checkout: Path) -> list[Path]:
    return [checkout / "README.md", checkout / "CONTRIBUTING.md", *sorted((checkout / "docs").rglob("*.md"))]


def test_links_lead_to_files(checkout: Path) -> None:
    for page in pages(checkout):
        for target in re.findall(r"\]\(([^)#\s]+)(?:#[^)]*)?\)", page.read_text(encoding="utf-8")):
            assert target.startswith(("http", "mailto")) or (page.parent / target).exists(), (page, target)


def test_every_page_is_in_the_index(checkout: Path) -> None:
    index = checkout / "docs" / "README.md"
    linked = {(index.parent / t).resolve() for t in re.findall(r"\]\(([^)#]+)", index.read_text())}
    assert [
        page for page in (checkout / "docs").rglob("*.md") if page.resolve() not in linked | {index}
    ] == []


def terms() -> list[tuple[str, str]]:
    text = (Path(__file__).resolve().parents[2] / "docs" / "glossary.md").read_text(encoding="utf-8")
    return re.findall(r"^\| ([^|]+) \| .+ \| `([\w.]+)` \|$", text, flags=re.MULTILINE)


def test_the_glossary_has_its_terms() -> None:
    assert len(terms()) > 25
    assert len({term for term, _ in terms()}) == len(terms())


@pytest.mark.parametrize(("term", "name"), terms())
def test_each_term_names_what_exists(term: str, name: str) -> None:
    try:
        import_module(f"intermit.{name}")
    except ModuleNotFoundError:
        module, _, attribute = name.rpartition(".")
        assert hasattr(import_module(f"intermit.{module}"), attribute), term
