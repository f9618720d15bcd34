"""The paper kit: pdflatex takes it with common packages only, whatever the names; digits are those known."""

import re
import subprocess
from pathlib import Path

import pytest
from hostile_text import HOSTILE
from intermit.reports import Record
from intermit.reports.build import report_files
from intermit.reports.numbers import write
from intermit.reports.paper.latex import quantity, text, unit
from intermit.reports.parts import figure_of
from intermit.reports.parts import quantity as known
from outside_tools import need
from respoken import respoken


def kit(report: dict[str, bytes], folder: Path) -> dict[str, bytes]:
    """The kit of a report, written to a folder."""
    files = {n.removeprefix("paper/"): d for n, d in report.items() if n.startswith("paper/")}
    for name, data in files.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(data)
    return files


def compiled(folder: Path) -> str:
    """Compile the kit; returns the log."""
    command = [need("pdflatex"), "-interaction=nonstopmode", "-halt-on-error", "-no-shell-escape", "kit.tex"]
    done = subprocess.run(command, cwd=folder, capture_output=True, check=False, timeout=300)
    log = done.stdout.decode("utf-8", "replace")
    assert done.returncode == 0, log[-3000:]
    return log


def test_the_kit_is_ascii_and_names_only_common_packages(report: dict[str, bytes], tmp_path: Path) -> None:
    files = kit(report, tmp_path)
    used = set(re.findall(rb"\\usepackage(?:\[[^]]*\])?\{(\w+)\}", b"".join(files.values())))
    common = {
        b"fontenc",
        b"textcomp",
        b"lmodern",
        b"geometry",
        b"amsmath",
        b"bm",
        b"booktabs",
        b"graphicx",
        b"pgfplots",
    }
    assert used <= common
    for name, data in files.items():
        if name.endswith((".tex", ".dat")):
            assert data.isascii(), name
    figures = {n.rsplit(".", 1)[0] for n in files if n.endswith(".svg")}
    assert figures
    for figure in figures:
        assert {f"{figure}.pdf", f"{figure}.tex"} <= files.keys()


@pytest.mark.latex
@pytest.mark.slow
def test_pdflatex_takes_it(report: dict[str, bytes], tmp_path: Path) -> None:
    need("pdflatex")
    kit(report, tmp_path)
    log = compiled(tmp_path)
    assert "undefined" not in log.lower().replace("undefined references", "")


@pytest.mark.latex
@pytest.mark.slow
def test_hostile_names_are_set_and_do_nothing(record: Record, tmp_path: Path) -> None:
    need("pdflatex")
    kit(report_files(respoken(record, *HOSTILE.values())), tmp_path)
    log = compiled(tmp_path)
    assert "/etc/passwd" not in re.findall(r"\((/[^\s()]+)", log)
    plain = subprocess.run(
        [need("pdftotext"), "-raw", "kit.pdf", "-"], cwd=tmp_path, check=True, capture_output=True
    ).stdout
    shown = "".join(plain.decode().split())
    for words in (
        "\\input{/etc/passwd}\\write18{id}\\end{document}",
        "100%of$x_i$",
        "<script>alert(1)</script>",
        "x" * 500,
        "longwords" * 50,
    ):
        assert words in shown
    assert shown.count("x") > len(HOSTILE["long"])  # whole, in the list of names


LATIN = "".join(chr(c) for c in (*range(0xA1, 0x180), *range(0x218, 0x21C)) if chr(c) not in "\xadĦħĸŦŧſ")
"""Latin-1 and Latin Extended-A without the soft hyphen and the letters that T1 has not; commas below."""


def test_latin_letters_are_ascii_commands_and_no_code_points() -> None:
    for c in LATIN:
        shown = text(c)
        assert shown.isascii()
        assert "U+" not in shown, c
    assert text("Søn Gaál, ½ µm ß") == r"S\o{}n Ga\'{a}l{,} \textonehalf{} \textmu{}m \ss{}"
    assert text("e\u0301") == text("é")
    assert "U+6F22" in text("漢")


@pytest.mark.latex
@pytest.mark.slow
def test_pdflatex_sets_every_latin_letter_as_itself(tmp_path: Path) -> None:
    need("pdflatex")
    words = [LATIN[i : i + 8] for i in range(0, len(LATIN), 8)]
    lines = "\n\n".join(text(word) for word in words)
    head = "\\documentclass{article}\\usepackage[T1]{fontenc}\\usepackage{textcomp,cmap,lmodern,amsmath}"
    (tmp_path / "kit.tex").write_text(f"{head}\\begin{{document}}\n{lines}\n\\end{{document}}\n")
    assert "Missing character" not in compiled(tmp_path)
    command = [need("pdftotext"), "-raw", "kit.pdf", "-"]
    plain = subprocess.run(command, cwd=tmp_path, check=True, capture_output=True).stdout.decode()
    whole = "ÀÁÂÃÄÅÆÇÈÉÊËÌÍÎÏÐÑÒÓÔÕÖØÙÚÛÜÝÞßàáâãäåæçèéêëìíîïðñòóôõöøùúûüýþÿĂ"
    whole += "ăĄąĆćČčĎďĘęĚěĞğİıĹĺŁłŃńŇňŊŋŐőŒœŔŕŘřŚśŞşŠšŤťŮůŰűŸŹźŻżŽž"
    assert set(whole) <= set(plain)  # those that T1 fonts hold; the others are an accent over a letter


def test_escaped_text_holds_no_command_of_the_users() -> None:
    for hostile in HOSTILE.values():
        escaped = text(hostile.encode("utf-8", "replace").decode())
        bare = re.sub(
            r"\\(text[a-z]+\{\}|['`^~=.\"ruHvck]\{[A-Za-z]\}|ldots\{\}|allowbreak\{\}|[{}$&#%_]|ensuremath\{[^{}]*(\{[^{}]*\})?\})",
            "",
            escaped,
        )
        assert "\\" not in bare.replace(r"\textbar{}", "")
        assert not re.search(r"[$&#%_^~]", bare)


@pytest.mark.parametrize(
    ("value", "shown"),
    [
        (known("b", 0.01072899, unit="N m", side="lower", rigorous=True), r"$\ge 0.010728\,\mathrm{N\,m}$"),
        (known("b", 7.1, side="upper"), r"$\le 7.1$"),
        (figure_of("p", 1.25e-9, digits=3), r"$1.25\times 10^{-9}$"),
        (known("i", -0.5, 0.5, unit="s"), r"$[-0.50,\,0.50]\,\mathrm{s}$"),
        (known("n", None), "--"),
    ],
)
def test_numbers_have_the_digits_that_are_known(value: dict, shown: str) -> None:
    assert quantity(value) == shown
    digits = re.findall(r"\d[\d.]*", write(value).low)
    assert all(d in shown for d in digits)


def test_units_are_upright() -> None:
    assert unit("kg m^2/s^2") == r"\mathrm{kg\,m^{2}/s^{2}}"
