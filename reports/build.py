"""All pages of a record, as files; and the folder that holds them."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from .content.blocks import Chapter, charts_of
from .content.budget import thin
from .content.chapters import chapters
from .content.comparing import comparison_chapters
from .content.figures import drawings, pdf_figures
from .content.heading import Heading, comparison_heading, heading
from .exports import export_files
from .folder import read_extras, write_folder
from .html import html_page
from .paper import paper_files
from .pdf import pdf_document
from .record import ARRAYS_NAME, DOCUMENT_NAME, Record, arrays_bytes, read_record

DRAWN_POINTS = 60_000
"""Values of all printed figures together."""


def report_files(record: Record) -> dict[str, bytes]:
    """Every file of the report by relative path; the same record gives the same bytes."""
    files = {DOCUMENT_NAME: record.to_json().encode(), ARRAYS_NAME: arrays_bytes(record.arrays)}
    return files | _pages(heading(record), chapters(record)) | export_files(record)


def _pages(top: Heading, contents: tuple[Chapter, ...]) -> dict[str, bytes]:
    """HTML, PDF and paper kit of the same chapters."""
    drawn = drawings(thin(charts_of(contents), DRAWN_POINTS))
    kit = paper_files(top, contents, drawn | pdf_figures(drawn))
    files = {
        "report.html": html_page(top, contents).encode(),
        "report.pdf": pdf_document(top, contents, drawn),
    }
    return files | {f"paper/{name}": data for name, data in kit.items()}


def write_report(
    record: Record, folder: str | Path, *, extras: Mapping[str, bytes] | None = None, force: bool = False
) -> Path:
    """Write the report's folder at once; `extras` (certificates) go in and survive a rebuild."""
    return write_folder(folder, report_files(record), extras=extras, force=force)


def rebuild_report(source: str | Path, folder: str | Path, *, force: bool = False) -> tuple[int, Path]:
    """Write the pages again from a record on disk, computing nothing; its extras come along.

    Returns the exit code the record holds, and the folder.
    """
    record = read_record(source)
    home = Path(source) if Path(source).is_dir() else Path(source).parent
    return exit_code(record), write_report(record, folder, extras=read_extras(home), force=force)


def comparison_files(a: Record, b: Record) -> dict[str, bytes]:
    """Two records and the pages that compare them."""
    files = _pages(comparison_heading(a, b), comparison_chapters(a, b))
    for name, record in (("A", a), ("B", b)):
        files[f"{name}/{DOCUMENT_NAME}"] = record.to_json().encode()
        files[f"{name}/{ARRAYS_NAME}"] = arrays_bytes(record.arrays)
    return files


def write_comparison(
    a: str | Path, b: str | Path, folder: str | Path, *, force: bool = False
) -> tuple[int, Path]:
    """Write the comparison of two records on disk; returns the worse exit code of the two, and the folder.

    1 (refuted) is worse than 3 (undecided), which is worse than 0.
    """
    one, two = read_record(a), read_record(b)
    codes = {exit_code(one), exit_code(two)}
    worst = next((code for code in (1, 3) if code in codes), 0)
    return worst, write_folder(folder, comparison_files(one, two), force=force)


def exit_code(record: Record) -> int:
    """Exit code of the study that made the record; 0 if it had none."""
    return record.outcome.exit_code if record.outcome is not None else 0
