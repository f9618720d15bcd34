"""The chapters as one PDF, set by Typst from data: text stays literal, only our equations are evaluated."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from datetime import UTC, datetime
from importlib.resources import files
from pathlib import Path
from typing import Any

from ..content.blocks import Chapter
from ..content.escape import font_folders, font_names
from ..content.heading import Heading
from ..content.names import FullNames
from ..content.wording import short
from ..whole_files import write_whole
from .blocks import spoken, words


def pdf_document(heading: Heading, chapters: tuple[Chapter, ...], drawings: Mapping[str, bytes]) -> bytes:
    """Typeset the chapters; `drawings` holds "<chart key>.svg"."""
    import typst

    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        data = json.dumps(_data(heading, chapters), ensure_ascii=False)
        write_whole(root / "data.json", data)
        source = files("intermit.reports").joinpath("templates/report.typ").read_text(encoding="utf-8")
        write_whole(root / "report.typ", source)
        for name, drawing in drawings.items():
            if name.endswith(".svg"):
                write_whole(root / name, drawing)
        options: Any = {"ignore_system_fonts": True, "font_paths": list(font_folders())}
        document: bytes = typst.compile(
            root / "report.typ", root=root, format="pdf", timestamp=_instant(heading.date), **options
        )
    return document


def _data(heading: Heading, chapters: tuple[Chapter, ...]) -> dict[str, object]:
    """Everything the template shows; names that were cut stand whole in a last chapter."""
    names = FullNames()
    shown: dict[str, object] = {
        "title": words(names.brief(heading.title)),
        "running": words(short(heading.title, 90)),
        "answer": words(names.brief(heading.sentence)),
        "scenario": words(names.brief(heading.scenario)),
        "author": words(names.brief(heading.author)),
        "date": words(heading.date or "undated"),
        "digests": list(heading.digests),
        "brief_digest": heading.brief_digest,
        "version": heading.version,
        "status": heading.status,
        "fonts": list(font_names()),
    }
    parts = [
        {
            "title": words(names.brief(c.title)),
            "blocks": [b for b in (spoken(b, names) for b in c.blocks) if b],
        }
        for c in chapters
    ]
    parts = [part for part in parts if part["blocks"]]  # a replay alone leaves nothing on paper
    if names.entries:
        rows = [[number, {"text": words(text)}] for number, text in names.entries]
        parts.append({"title": "Names in full", "blocks": [{"kind": "facts", "title": "", "rows": rows}]})
    return shown | {"chapters": parts}


def _instant(date: str) -> int:
    """Seconds since 1970 of the record's date, 0 if it has none: the PDF's own date, never the clock's."""
    try:
        return int(datetime.fromisoformat(date).replace(tzinfo=UTC).timestamp()) if date else 0
    except (ValueError, OverflowError):
        return 0
