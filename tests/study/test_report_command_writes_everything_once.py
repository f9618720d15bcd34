"""`intermit report`: a scenario in, a folder out; a record in, the same pages again."""

import json
from collections.abc import Callable
from pathlib import Path

import pytest

Run = Callable[..., tuple[int, str, str]]
PAGES = (
    "report.html",
    "report.pdf",
    "results.json",
    "results.npz",
    "series.mat",
    "paper/kit.tex",
    "manifest.json",
)


def files(folder: Path) -> dict[str, bytes]:
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in folder.rglob("*") if p.is_file()}


@pytest.mark.slow
def test_a_scenario_becomes_a_report_and_rebuilds_alike(
    intermit: Run, write_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    scenario = write_scenario()
    out = tmp_path / "out"
    options = ("--no-optimum", "--no-compare", "--no-margins", "--date", "2021-02-01", "--author", "A <b>")
    code, words, said = intermit("report", scenario, "-o", out, *options)
    assert code == 0, said
    assert "proved" in words
    written = files(out)
    assert set(PAGES) <= set(written)
    document = json.loads(written["results.json"])
    assert document["provenance"]["date"] == "2021-02-01"
    assert document["provenance"]["author"] == "A <b>"

    assert intermit("report", out / "results.json", "-o", tmp_path / "again")[0] == 0
    assert files(tmp_path / "again") == written
    assert intermit("report", out, "-o", out)[0] == 0
    assert files(out) == written

    code, _, said = intermit("report", out, tmp_path / "again", "-o", tmp_path / "both")
    assert code == 0, said
    assert "0 with another verdict" in (tmp_path / "both" / "report.html").read_text(encoding="utf-8")

    (out / "thesis.tex").write_text("mine", encoding="utf-8")
    code, _, said = intermit("report", out / "results.json", "-o", out)
    assert code == 2
    assert "thesis.tex" in said
    assert len(said.splitlines()) == 1
    assert intermit("report", out / "results.json", "-o", out, "--force")[0] == 0
    assert (out / "thesis.tex").read_text(encoding="utf-8") == "mine"


@pytest.mark.slow
def test_a_report_holds_the_front_and_the_audit_it_asks_for(
    intermit: Run, write_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    law = '[[law]]\ntype = "persistence-filter"\nlabel = "filter"\n'
    scenario = write_scenario(
        f'{law}[report]\naudit = true\nfront = [36]\nfront_laws = ["filter"]\nfront_evaluations = 60\n'
    )
    options = ("--no-optimum", "--no-compare", "--no-margins")
    for further, expected in (((), True), (("--no-front", "--no-audit"), False)):
        out = tmp_path / str(expected)
        code, _, said = intermit("report", scenario, "-o", out, *options, *further)
        assert code == 0, said
        sections = json.loads((out / "results.json").read_text(encoding="utf-8"))["sections"]
        assert [bool(sections.get(name)) for name in ("front", "audit")] == [expected, expected]


def test_what_cannot_be_reported_is_refused_in_one_line(
    intermit: Run, write_scenario: Callable[..., Path], tmp_path: Path
) -> None:
    scenario = write_scenario()
    (tmp_path / "bad.json").write_text("{}", encoding="utf-8")
    (tmp_path / "mine").mkdir()
    (tmp_path / "mine" / "file").write_text("x", encoding="utf-8")
    for arguments in (
        (tmp_path / "bad.json",),
        (scenario, tmp_path / "bad.json"),
        (scenario, scenario),
        (tmp_path / "none.json",),
    ):
        code, _, said = intermit("report", *arguments, "-o", tmp_path / "out")
        assert code == 2
        assert len(said.splitlines()) == 1
    code, _, said = intermit("report", scenario, "-o", tmp_path / "mine")
    assert code == 2
    assert "not written by intermit" in said
