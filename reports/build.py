"""All pages of a record, as files; and the folder that holds them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from .content.blocks import charts_of
from .content.budget import thin
from .content.chapters import chapters
from .content.drawn import drawings, pdf_figures
from .folder import read_extras, write_folder
from .html import html_page
from .paper import paper_files
from .pdf import pdf_document
from .record import ARRAYS_NAME, DOCUMENT_NAME, Record, arrays_bytes, read_record

DRAWN_POINTS = 60_000
"""Values of all printed figures together."""


def report_files(record: Record) -> dict[str, bytes]:
    """Every file of the report by relative path; the same record gives the same bytes."""
    contents = chapters(record)
    files = {DOCUMENT_NAME: record.to_json().encode(), ARRAYS_NAME: arrays_bytes(record.arrays)}
    files["report.html"] = html_page(record, contents).encode()
    drawn = drawings(thin(charts_of(contents), DRAWN_POINTS))
    files["report.pdf"] = pdf_document(record, contents, drawn)
    kit = paper_files(record, contents, drawn | pdf_figures(drawn))
    return files | {f"paper/{name}": data for name, data in kit.items()}


def write_report(
    record: Record, folder: str | Path, *, extras: Mapping[str, bytes] | None = None, force: bool = False
) -> Path:
    """Write the report's folder at once; `extras` (certificates) go in and survive a rebuild."""
    return write_folder(folder, report_files(record), extras=extras, force=force)


def rebuild_report(source: str | Path, folder: str | Path, *, force: bool = False) -> Path:
    """Write the pages again from a record on disk, computing nothing; its extras come along."""
    record = read_record(source)
    home = Path(source) if Path(source).is_dir() else Path(source).parent
    return write_report(record, folder, extras=read_extras(home), force=force)
