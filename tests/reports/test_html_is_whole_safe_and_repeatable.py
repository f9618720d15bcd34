"""The page holds every number of the record, runs nothing foreign, and is the same every time."""

import html.parser
import json
import re

import numpy as np
import pytest
from hostile_text import HOSTILE
from intermit.reports import Record
from intermit.reports.content.blocks import charts_of
from intermit.reports.content.budget import keep, thin
from intermit.reports.content.chapters import chapters
from intermit.reports.content.heading import heading
from intermit.reports.content.wording import short, visible
from intermit.reports.html import html_page
from intermit.reports.numbers import write
from respoken import respoken
from synthetic_record import make, quantities, thaw


class Reader(html.parser.HTMLParser):
    """Elements, attributes and visible text of a page."""

    def __init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self.elements: list[tuple[str, dict[str, str | None]]] = []
        self.words: list[str] = []
        self.raw = False

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.elements.append((tag, dict(attrs)))
        self.raw = tag in {"script", "style"}

    def handle_endtag(self, tag: str) -> None:
        del tag
        self.raw = False

    def handle_data(self, data: str) -> None:
        if not self.raw:
            self.words.append(data)


def read(page: str) -> Reader:
    reader = Reader()
    reader.feed(page)
    return reader


def page_of(record: Record) -> str:
    return html_page(heading(record), chapters(record))


def test_every_number_and_claim_of_the_record_is_on_the_page(record: Record) -> None:
    reader = read(page_of(record))
    text = " ".join("".join(reader.words).split())
    document = thaw(record.document)
    found = quantities(record)
    assert len(found) > 40
    for q in found:
        assert write(q, unit=False).text in text, q
    for case in document["sections"]["cases"]:
        for claim in case["claims"]:
            assert claim["statement"] in text
            assert claim["reason"] in text
    assert text.index("10 claims asked: 8 PROVED, 1 REFUTED, 1 UNDECIDED.") < text.index("R stays positive")


def test_the_verdict_table_comes_first(record: Record) -> None:
    sections = [a["id"] for tag, a in read(page_of(record)).elements if tag == "section"]
    assert sections[0] == "verdicts"
    assert {"schedule", "torque", "optimum", "front", "claims", "provenance"} <= set(sections)


def test_same_record_same_bytes(record: Record) -> None:
    assert page_of(record) == page_of(make())


def test_the_page_is_small_and_asks_for_nothing(record: Record) -> None:
    page = page_of(record)
    assert len(page.encode()) < 3_000_000
    reader = read(page)
    for tag, attributes in reader.elements:
        assert tag not in {"link", "iframe", "object", "embed", "form", "img", "base"}
        for name in ("src", "srcset", "action", "data", "poster"):
            assert name not in attributes
        for name in ("href", "xlink:href"):
            assert (attributes.get(name) or "#").startswith("#")
    policy = next(
        a["content"] for t, a in reader.elements if a.get("http-equiv") == "Content-Security-Policy"
    )
    assert policy is not None
    assert "default-src 'none'" in policy
    assert "form-action 'none'" in policy
    assert "unsafe-inline" not in policy.split("script-src")[1].split(";")[0]
    assert "showSendToCloud: false" in page
    assert 'plotlyServerURL: ""' in page


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_text_is_shown_as_text(record: Record, kind: str) -> None:
    page = page_of(respoken(record, HOSTILE[kind]))
    harmless = "q" * len(HOSTILE[kind])  # as long, since names cut in a figure are listed below it
    plain, attacked = read(page_of(respoken(record, harmless))), read(page)
    assert [tag for tag, _ in attacked.elements] == [tag for tag, _ in plain.elements]
    handlers = [name for _, a in attacked.elements for name in a if name.startswith("on")]
    assert not handlers
    shown = visible(HOSTILE[kind].encode("utf-8", "replace").decode())
    words = "".join(attacked.words)
    assert words.count(shown) > 30
    assert not re.search("[\x00-\x08\x0b-\x1f\u202a-\u202e]", page)


def test_the_script_data_is_json_and_holds_no_markup(record: Record) -> None:
    page = page_of(respoken(record, HOSTILE["closing"]))
    data = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert data is not None
    loaded = json.loads(data[1])
    assert len(loaded["charts"]) == len(charts_of(chapters(record)))
    assert "<" not in data[1]


def test_one_budget_is_shared_and_no_peak_is_lost() -> None:
    rng = np.random.default_rng(3)
    record = make()
    charts = charts_of(chapters(record))
    thinned = thin(charts, 20_000)
    stored = sum(len(line.y) for c in thinned for line in c.lines)
    assert stored < 20_000
    for before, after in zip(charts, thinned, strict=True):
        for one, other in zip(before.lines, after.lines, strict=True):
            assert other.y.max() == one.y.max()
            assert other.y.min() == one.y.min()
            assert (other.x[0], other.x[-1]) == (one.x[0], one.x[-1])
            if np.all(np.diff(one.x) >= 0):
                assert np.all(np.diff(other.x) >= 0)
    walk = rng.normal(size=100_000)
    assert len(keep([walk], 1000)) <= 1002


def test_a_larger_budget_is_left_alone(record: Record) -> None:
    charts = charts_of(chapters(record))
    assert thin(charts, 10**9) == charts


def test_names_inside_figures_are_short() -> None:
    assert short("a\n b   c") == "a b c"
    assert len(short("x" * 1000)) == 60


@pytest.mark.parametrize(
    "missing", ["cases", "schedule", "optimum", "scenario", "samples", "front", "audit", "comparison"]
)
def test_any_section_may_be_missing(missing: str) -> None:
    page = page_of(make(**{missing: None}))
    assert "<h1>" in page


def test_a_record_with_nothing_in_it_still_makes_a_page() -> None:
    from intermit.reports.provenance import provenance

    empty = Record.create(title="t", provenance=provenance(scenario_name="s", scenario_text=""), sections={})
    assert "No claim was asked for." in page_of(empty)


def test_a_study_without_claims_leads_with_its_summary() -> None:
    record = make(cases=None, schedule=None, optimum=None)
    assert "Every point is simulated again." in page_of(record).split("</header>")[0]
