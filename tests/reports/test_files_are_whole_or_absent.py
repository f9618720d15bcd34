"""A disk that fills up leaves no half file and no remnant, and the message names the file."""

import errno
import os
import re
import resource
import subprocess
import sys
from pathlib import Path

import intermit
import pytest
from intermit.reports.folder import write_folder
from intermit.reports.whole_files import write_whole
from intermit.scenario import ScenarioError, write_template

EXAMPLES = Path(intermit.__file__).parent / "examples"


def full_disk(*_):
    raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))


@pytest.mark.parametrize("data", ["text", b"bytes"])
def test_a_file_replaces_what_was_there(tmp_path, data):
    path = tmp_path / "a.json"
    path.write_text("old")
    write_whole(path, data)
    assert path.read_bytes() == (data.encode() if isinstance(data, str) else data)
    assert os.listdir(tmp_path) == ["a.json"]


def test_a_full_disk_keeps_the_old_file_and_names_it(tmp_path, monkeypatch):
    path = tmp_path / "a.json"
    path.write_text("old")
    monkeypatch.setattr(os, "replace", full_disk)
    with pytest.raises(OSError, match="No space left") as caught:
        write_whole(path, "new")
    assert caught.value.filename == str(path)
    assert path.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.json"]


def test_a_new_file_takes_no_place_that_is_taken(tmp_path):
    path = tmp_path / "a.toml"
    write_whole(path, "first", new=True)
    with pytest.raises(FileExistsError):
        write_whole(path, "second", new=True)
    assert path.read_text() == "first"
    assert os.listdir(tmp_path) == ["a.toml"]


def test_a_full_disk_leaves_no_report_and_no_scenario(tmp_path, monkeypatch):
    def half(path, data):
        with path.open("wb") as stream:
            stream.write(data[: len(data) // 2])
        full_disk()

    monkeypatch.setattr(Path, "write_bytes", half)
    with pytest.raises(OSError, match="No space left") as caught:
        write_folder(tmp_path / "report", {"index.html": b"page"})
    assert caught.value.filename == str(tmp_path / "report" / "index.html")
    with pytest.raises(ScenarioError, match=r"own\.toml: cannot be written: No space left"):
        write_template(tmp_path / "own.toml")
    assert os.listdir(tmp_path) == []


@pytest.mark.slow
@pytest.mark.parametrize(
    "command",
    [["certify", "cut.toml", "-o", "out.json"], ["check", "cut.toml", "--json", "out.json", "--no-search"]],
)
def test_commands_end_with_one_line_when_no_more_can_be_written(tmp_path, command):
    (tmp_path / "cut.toml").write_text((EXAMPLES / "paper.toml").read_text())

    def limit():
        resource.setrlimit(resource.RLIMIT_FSIZE, (2000, 2000))

    done = subprocess.run(
        [sys.executable, "-m", "intermit", *command],
        cwd=tmp_path, capture_output=True, text=True, check=False, preexec_fn=limit,
    )  # fmt: skip
    assert done.returncode == 2, done.stderr
    assert re.search(r"out\.(json|npz): File too large", done.stderr)
    assert sorted(os.listdir(tmp_path)) == ["cut.toml"]
