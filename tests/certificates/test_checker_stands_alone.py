"""The checker needs nothing but Python, proves from the file alone and refuses what it cannot read."""

import ast
import json
import subprocess
import sys
from fractions import Fraction
from pathlib import Path

import pytest
from intermit.cli.app import run
from intermit.models.rigid_body import RigidBody
from intermit.verify import checker
from intermit.verify.certificates import Certificate, certificate_text, exact_text
from intermit.verify.certificates.checker_archive import checker_archive
from intermit.verify.lyapunov.conditions import sharp_certificate

J1 = [["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]]


FOLDER = Path(checker.__file__).parent


def sharp(lam: str = "0.525", weight: str = "1") -> str:
    return certificate_text(
        [sharp_certificate(Fraction(lam), RigidBody.from_rows(J1), weight=Fraction(weight))]
    )


def edited(text: str, edit) -> str:
    document = json.loads(text)
    edit(document)
    return json.dumps(document)


def test_runs_isolated_and_without_site(tmp_path):
    file = tmp_path / "c.json"
    file.write_text(sharp())
    command = [sys.executable, "-I", "-S", str(FOLDER), str(file)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "VALID  sharp-condition" in done.stdout
    assert "1 of 1 valid" in done.stdout
    file.write_text(sharp("0.34"))
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 1
    assert "INVALID  sharp-condition" in done.stdout
    command[-1] = str(tmp_path / "absent.json")
    assert subprocess.run(command, capture_output=True, check=False).returncode == 2


def test_imports_only_the_standard_library_and_itself():
    names = set()
    for path in FOLDER.glob("*.py"):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Import):
                names |= {alias.name.split(".")[0] for alias in node.names}
            elif isinstance(node, ast.ImportFrom) and node.level == 0:
                names.add(str(node.module).split(".")[0])
            elif isinstance(node, ast.ImportFrom):
                assert node.level == 1, f"{path.name} reaches out of the checker"
    assert names <= set(sys.stdlib_module_names)


def test_no_file_of_it_hides_a_module_of_python():
    """As a folder that is run, its files come first in the path."""
    assert not {path.stem for path in FOLDER.glob("*.py")} & set(sys.stdlib_module_names) - {"__main__"}


def test_it_can_be_read_in_parts():
    lines = {path.stem: path.read_text(encoding="utf-8").count("\n") for path in FOLDER.glob("*.py")}
    kernel = ("exact_numbers", "reading", "matrices", "polynomials", "bernstein")
    assert sum(lines[name] for name in kernel) <= 700
    assert max(lines.values()) <= 400


def test_it_runs_as_one_file_away_from_the_package(tmp_path, capsys):
    archive, file = tmp_path / "checker.pyz", tmp_path / "c.json"
    assert run(["certify", "--checker", str(archive)]) == 0
    assert "checker.pyz" in capsys.readouterr().out
    for lam, code, word in (("0.525", 0, "VALID  sharp"), ("0.34", 1, "INVALID  sharp")):
        file.write_text(sharp(lam))
        command = [sys.executable, "-I", "-S", str(archive), str(file)]
        done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=tmp_path)
        assert done.returncode == code, done.stderr
        assert word in done.stdout
    assert checker_archive() == archive.read_bytes(), "the same sources make the same bytes"
    assert run(["certify", "-o", str(file)]) == 2
    assert "SCENARIO.toml is missing" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("lam", "valid"), [("0.3409", True), ("0.34090", True), ("0.3408", False), ("-0.5", False), ("0", False)]
)
def test_sharp_condition_is_decided_exactly(lam, valid):
    assert [f.valid for f in checker.check_text(sharp(lam))] == [valid]


def test_sharp_condition_holds_at_equality_and_not_a_hair_below():
    def text(lam: Fraction) -> str:
        body = RigidBody.from_rows([[4 if i == j else 0 for j in range(3)] for i in range(3)])
        return certificate_text([sharp_certificate(lam, body)])

    assert checker.check_text(text(Fraction(1, 4)))[0].valid
    assert not checker.check_text(text(Fraction(1, 4) - Fraction(1, 10**40)))[0].valid


@pytest.mark.parametrize(
    ("edit", "reason"),
    [
        (lambda d: d.update(format="other"), "format"),
        (lambda d: d.update(version="2"), "version"),
        (lambda d: d["parts"][0].update(certificates=[]), "no certificate"),
        (lambda d: d.update(extra="1"), "nothing reads"),
        (lambda d: d["parts"][0]["data"].update(extra="1"), "nothing reads"),
        (lambda d: d["parts"][0]["certificates"][0].update(kind="other"), "knows no certificate"),
        (lambda d: d["parts"][0]["certificates"][0]["witness"].update(extra="1"), "nothing reads"),
        (lambda d: d["parts"][0]["certificates"][0]["claim"].update(weight=1.5), "exact string"),
        (lambda d: d["parts"][0]["certificates"][0]["claim"].update(weight="1/0"), "exact number"),
        (lambda d: d["parts"][0]["certificates"][0]["claim"].update(weight="nan"), "exact number"),
        (lambda d: d["parts"][0]["certificates"][0]["claim"].update(weight="1e99999"), "exact number"),
        (lambda d: d["parts"][0]["certificates"][0]["claim"].update(weight=True), "exact number"),
        (lambda d: d["parts"][0]["certificates"][0]["claim"].update(weight=[]), "exact number"),
        (lambda d: d["parts"][0]["data"]["inertia"].pop(), "3 rows"),
        (lambda d: d["parts"][0]["data"]["inertia"][0].pop(), "3 numbers"),
        (lambda d: d["parts"][0]["data"]["inertia"][0].__setitem__(1, "0.15"), "symmetric"),
        (lambda d: d["parts"][0].pop("data"), "missing"),
    ],
)
def test_a_malformed_file_is_refused_with_the_reason(edit, reason):
    findings = checker.check_text(edited(sharp(), edit))
    assert not all(f.valid for f in findings)
    assert any(reason in f.reason for f in findings)


@pytest.mark.parametrize("text", ["", "[]", "1", "{", '{"format": 1, "format": 2}', "[" * 100000, "NaN"])
def test_what_is_not_a_certificate_file_is_refused(text):
    assert not any(f.valid for f in checker.check_text(text))


def test_exact_text_is_exact():
    for value in ("1/3", "0.1", "-12.5", "7", "-1/1024", "3.05", "0", "-0.001"):
        assert Fraction(exact_text(Fraction(value))) == Fraction(value)
    assert exact_text(Fraction("3.05")) == "3.05"
    assert exact_text(Fraction(-1, 3)) == "-1/3"


def test_certificates_share_a_part_where_their_data_agree():
    first = Certificate("a", {"x": 1, "p": {"u": 1}}, {})
    second = Certificate("b", {"y": 1, "p": {"v": 1}}, {})
    third = Certificate("c", {"p": {"u": 2}}, {})
    parts = json.loads(certificate_text([first, second, third]))["parts"]
    assert [part["data"] for part in parts] == [
        {"x": "1", "y": "1", "p": {"u": "1", "v": "1"}},
        {"p": {"u": "2"}},
    ]


def test_a_file_needs_a_certificate_and_exact_numbers():
    with pytest.raises(TypeError, match="exact numbers"):
        certificate_text([Certificate("sharp-condition", {"x": 0.5}, {})])
    with pytest.raises(ValueError, match="nothing to certify"):
        certificate_text([])


def test_positive_semidefinite_matrices_are_told_from_others():
    F = Fraction
    assert checker.is_positive_semidefinite([[F(1), F(1)], [F(1), F(1)]])
    assert not checker.is_positive_definite([[F(1), F(1)], [F(1), F(1)]])
    assert not checker.is_positive_semidefinite([[F(0), F(1)], [F(1), F(5)]])
    assert not checker.is_positive_semidefinite([[F(1), F(2)], [F(1), F(5)]])
    assert checker.is_positive_semidefinite([[F(0), F(0)], [F(0), F(5)]])
