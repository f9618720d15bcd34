"""Records of one input join into one; two records stand side by side with what changed first."""

import io
from pathlib import Path

import numpy as np
import pypdf
import pytest
from hostile_text import HOSTILE
from intermit.reports import Record, RecordError, read_record, write_record
from intermit.reports.build import comparison_files, rebuild_report, write_comparison, write_report
from intermit.reports.content.comparing import comparison_chapters, comparison_sentence
from intermit.reports.join import join
from respoken import respoken
from synthetic_record import make, thaw


def part(record: Record, *keep: str) -> Record:
    sections = {k: thaw(v) for k, v in record.document["sections"].items() if k in keep}
    text = repr(sections)
    return Record.create(
        title="part",
        provenance=thaw(record.document["provenance"]),
        sections=sections,
        arrays={k: v for k, v in record.arrays.items() if f"'{k}'" in text},
        outcome=thaw(record.document["outcome"]),
    )


def test_parts_join_into_the_whole(record: Record) -> None:
    halves = [
        part(record, "scenario", "schedule", "cases", "samples"),
        part(record, "scenario", "optimum", "front"),
    ]
    whole = join(halves, title="whole", command="intermit report", date="2022-03-04")
    assert set(whole.document["sections"]) == {"scenario", "schedule", "cases", "samples", "optimum", "front"}
    assert whole.document["provenance"]["date"] == "2022-03-04"
    assert whole.sections.cases == record.sections.cases
    assert whole.document["outcome"]["exit_code"] == 1


def test_records_of_other_inputs_or_rival_sections_do_not_join(record: Record) -> None:
    other = thaw(record.document["provenance"]) | {"input_sha256": "0" * 64}
    changed = Record.create(title="x", provenance=other, sections={})
    with pytest.raises(RecordError, match="different inputs"):
        join([record, changed], title="t")
    rival = {"comparison": {"summary": "otherwise"}}
    rival_record = Record.create(title="x", provenance=thaw(record.document["provenance"]), sections=rival)
    with pytest.raises(RecordError, match="'comparison'"):
        join([record, rival_record], title="t")
    one = {"figures": [figure_of_array()]}
    arrays = {"schedule.time": np.zeros(3)}
    same_name = Record.create(
        title="x", provenance=thaw(record.document["provenance"]), sections={"tuning": one}, arrays=arrays
    )
    with pytest.raises(RecordError, match=r"'schedule\.time'"):
        join([record, same_name], title="t")


def figure_of_array() -> dict[str, object]:
    line = {"label": "l", "x": "schedule.time", "y": "schedule.time"}
    return {"key": "k", "title": "t", "x": {"label": "x"}, "y": {"label": "y"}, "series": [line], "alt": "a"}


def revised(record: Record) -> Record:
    document = thaw(record.document)
    claim = document["sections"]["cases"][1]["claims"][4]
    claim |= {"verdict": "UNDECIDED", "witness": None}
    document["provenance"]["scenario_text"] = document["provenance"]["scenario_text"].replace(
        "period = 8.0", "period = 9.0"
    )
    return Record.create(
        title="revised",
        provenance=document["provenance"],
        sections=document["sections"],
        arrays=record.arrays,
        outcome={"exit_code": 3},
    )


def test_what_changed_comes_first(record: Record) -> None:
    other = revised(record)
    assert comparison_sentence(record, other) == "12 claims in both: 1 with another verdict."
    chapters = comparison_chapters(record, other)
    table = chapters[0].blocks[1]
    assert table.rows[0]["change"] == "changed"  # type: ignore[union-attr]
    assert table.rows[0]["A"].verdict == "REFUTED"  # type: ignore[union-attr]
    assert [row["change"] for row in table.rows[1:]] == ["same"] * 11  # type: ignore[union-attr]
    page = comparison_files(record, other)["report.html"].decode()
    assert "-period = 8.0" in page
    assert "+period = 9.0" in page
    assert record.sha256 in page
    assert other.sha256 in page


def test_the_comparison_comes_on_paper_too(record: Record) -> None:
    files = comparison_files(record, revised(record))
    assert files["report.pdf"].startswith(b"%PDF")
    text = "".join(page.extract_text() for page in pypdf.PdfReader(io.BytesIO(files["report.pdf"])).pages)
    for words in ("1 with another verdict", "period = 9.0", record.sha256, "Margin in B"):
        assert "".join(words.split()) in "".join(text.split()), words
    assert {"paper/kit.tex", "paper/tables/verdicts.tex", "paper/figures/torque-1.pdf"} <= files.keys()
    assert comparison_files(record, revised(record)) == files


def test_a_record_beside_itself_changes_nothing(record: Record) -> None:
    assert ": 0 with another verdict." in comparison_sentence(record, record)


def test_records_with_nothing_in_common_still_compare(record: Record) -> None:
    other = make(cases=None, schedule=None, optimum=None)
    assert "in one record only" in comparison_sentence(record, other)
    assert comparison_files(record, other)["report.html"]


def test_hostile_names_compare_safely(record: Record) -> None:
    page = comparison_files(respoken(record, *HOSTILE.values()), record)["report.html"].decode()
    assert "<script>alert" not in page
    assert "onerror=alert(1)>" not in page.replace("&#34;", '"').split("<script>")[0] or "&lt;img" in page


def test_comparison_and_rebuild_through_the_disk(record: Record, tmp_path: Path) -> None:
    for name, one in (("one", record), ("two", revised(record))):
        (tmp_path / name).mkdir()
        write_record(one, tmp_path / name)
    code, folder = write_comparison(tmp_path / "one", tmp_path / "two" / "results.json", tmp_path / "both")
    assert code == 1
    assert read_record(folder / "A").sha256 == record.sha256
    write_report(record, tmp_path / "report", extras={"certificates/c.json": b"{}"})
    before = {p: p.read_bytes() for p in (tmp_path / "report").rglob("*") if p.is_file()}
    code, _ = rebuild_report(tmp_path / "report" / "results.json", tmp_path / "report")
    assert code == 1
    assert before == {p: p.read_bytes() for p in (tmp_path / "report").rglob("*") if p.is_file()}
