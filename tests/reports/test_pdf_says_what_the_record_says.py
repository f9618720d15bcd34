"""The PDF: every number of the record, contents, page numbers, the same bytes; hostile names as text."""

import io
import subprocess
from functools import cache
from pathlib import Path

import pytest
from hostile_text import HOSTILE
from intermit.reports import Record
from intermit.reports.build import DRAWN_POINTS, report_files
from intermit.reports.content.blocks import charts_of
from intermit.reports.content.budget import thin
from intermit.reports.content.chapters import chapters
from intermit.reports.content.escape import directed, east_asian_font, printable
from intermit.reports.content.figures import drawings, pdf_figures
from intermit.reports.content.heading import heading
from intermit.reports.numbers import write
from intermit.reports.parts import quantity
from intermit.reports.pdf import pdf_document
from intermit.reports.pdf.blocks import cell
from outside_tools import need
from respoken import respoken
from synthetic_record import make, quantities

pypdf = pytest.importorskip("pypdf")


def pdf_of(record: Record) -> bytes:
    contents = chapters(record)
    return pdf_document(heading(record), contents, drawings(thin(charts_of(contents), DRAWN_POINTS)))


def squeezed(text: str) -> str:
    """Without what a line break may add or take away."""
    return "".join(c for c in text if not c.isspace() and c not in "\u200b\u00ad\ufe0f")


@pytest.fixture(scope="module")
def document(record: Record) -> bytes:
    return pdf_of(record)


@cache
def pages(document: bytes) -> list[str]:
    return [page.extract_text() for page in pypdf.PdfReader(io.BytesIO(document)).pages]


def test_every_number_of_the_record_is_in_the_text(record: Record, document: bytes) -> None:
    text = squeezed("".join(pages(document)))
    for q in quantities(record):
        assert squeezed(write(q, unit=False).text) in text, q


def test_a_value_may_break_before_its_unit_and_nowhere_else() -> None:
    """In a narrow column values ran into each other; a number or a unit is never torn."""
    shown = cell(quantity("peak", 0.00024257, 0.00024258, unit="N m", side="lower"))["text"]
    assert shown == "≥\u00a00.00024257 N·m"
    assert str(cell(quantity("range", 1.0, 2.0, unit="s"))["text"]).count(" ") == 1


def test_no_page_begins_with_the_last_line_of_a_short_table(document: bytes) -> None:
    """Every claim's facts end with how to check again; none of those ends stands alone on a page."""
    for page in pages(document)[1:]:
        lines = [line.strip() for line in page.splitlines() if line.strip()]
        assert not lines[1].startswith("Check again intermit"), lines[:3]


def test_first_page_has_title_answer_hash_and_verdicts(record: Record, document: bytes) -> None:
    first = squeezed(pages(document)[0])
    for words in (
        record.title,
        "10 claims asked",
        "2021-02-01",
        record.sha256,
        "R stays positive",
        "REFUTED",
    ):
        assert squeezed(words) in first
    assert "Wherethiscomesfrom" in first


def test_pages_are_numbered(document: bytes) -> None:
    texts = pages(document)
    for i, text in enumerate(texts):
        assert f"page{i + 1}of{len(texts)}" in squeezed(text)


def test_figures_are_vectors(document: bytes) -> None:
    reader = pypdf.PdfReader(io.BytesIO(document))
    assert sum(len(page.images) for page in reader.pages) == 0


def test_same_record_same_bytes(record: Record, document: bytes) -> None:
    assert pdf_of(make()) == document
    assert str(pypdf.PdfReader(io.BytesIO(document)).metadata["/CreationDate"]).startswith("D:20210201")


def test_printed_figures_repeat(record: Record) -> None:
    charts = charts_of(chapters(record))[:2]
    assert drawings(charts) == drawings(charts)
    assert pdf_figures(drawings(charts)) == pdf_figures(drawings(charts))


def test_the_users_matplotlib_settings_change_nothing(record: Record) -> None:
    import matplotlib

    charts = charts_of(chapters(record))[:1]
    plain = drawings(charts)
    with matplotlib.rc_context({"font.size": 30, "axes.facecolor": "red", "svg.fonttype": "none"}):
        assert drawings(charts) == plain


def test_hostile_names_are_set_as_text(record: Record) -> None:
    texts = {k: v for k, v in HOSTILE.items() if k not in {"long", "words"}}
    text = squeezed("".join(pages(pdf_of(respoken(record, *texts.values())))))
    for kind, hostile in texts.items():
        if kind != "right to left":  # the order of extraction differs
            assert squeezed(printable(hostile.encode("utf-8", "replace").decode())) in text, kind
    assert "‹RLO›" in text


def test_long_names_stand_whole_once_and_short_elsewhere(record: Record) -> None:
    names = (*["quiet"] * 50, HOSTILE["long"])
    text = pages(pdf_of(respoken(record, *names)))
    start = next(i for i, page in enumerate(text) if "Names in full" in page and i > 0)
    listed = squeezed("".join(text[start:])).split("Namesinfull")[1]
    assert listed.count("x") == len(HOSTILE["long"])
    assert "[name1]" in squeezed("".join(text[:start]))


def test_right_to_left_words_are_set_with_their_own_letters(record: Record) -> None:
    shown = "".join(pages(pdf_of(respoken(record, "لوح שמש"))))
    assert set("שמש") <= set(shown)
    assert "U+" not in shown


def test_a_text_is_ordered_by_its_own_first_letter() -> None:
    assert directed("plain (J1)") == "plain (J1)"
    assert directed("שמש (J1)") == "\u2068שמש (J1)\u2069"


def test_an_east_asian_font_is_used_where_it_is_installed() -> None:
    if east_asian_font() is None:
        assert printable("漢") == "‹U+6F22›"
    else:
        assert printable("漢") == "漢"


def test_every_file_of_the_report_repeats(report: dict[str, bytes]) -> None:
    one, two = report, report_files(make())
    assert one.keys() == two.keys()
    assert [name for name in one if one[name] != two[name]] == []


@pytest.mark.poppler
def test_poppler_reads_and_draws_every_page(document: bytes, tmp_path: Path) -> None:
    need("pdftotext")
    path = tmp_path / "r.pdf"
    path.write_bytes(document)
    text = subprocess.run([need("pdftotext"), path, "-"], check=True, capture_output=True, text=True).stdout
    assert "8 PROVED, 1 REFUTED, 1 UNDECIDED" in text
    subprocess.run([need("pdftoppm"), "-r", "30", "-gray", path, tmp_path / "p"], check=True)
    drawn = sorted(tmp_path.glob("p-*.pgm"))
    assert len(drawn) == len(pages(document))
    for page in drawn:
        values = page.read_bytes()[-30_000:]
        assert len(set(values)) > 8  # not blank
