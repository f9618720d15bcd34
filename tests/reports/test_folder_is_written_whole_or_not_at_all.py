"""An interrupted run leaves the old report; nothing that is somebody else's is replaced."""

from pathlib import Path

import pytest
from intermit.reports import folder as folder_module
from intermit.reports.folder import FolderError, read_extras, write_folder


def names(folder: Path) -> list[str]:
    return sorted(p.relative_to(folder).as_posix() for p in folder.rglob("*") if p.is_file())


@pytest.fixture(params=[True, False], ids=["exchange", "two renames"])
def system(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    if not request.param:
        monkeypatch.setattr(folder_module, "_exchange", lambda *_: False)


def test_a_second_report_replaces_the_first(tmp_path: Path, system: None) -> None:
    target = tmp_path / "deep" / "out"
    write_folder(target, {"a.html": b"1", "old/b": b"2"}, extras={"certificates/c.json": b"3"})
    assert names(target) == ["a.html", "certificates/c.json", "manifest.json", "old/b"]
    write_folder(target, {"a.html": b"4"}, extras=read_extras(target))
    assert names(target) == ["a.html", "certificates/c.json", "manifest.json"]
    assert (target / "a.html").read_bytes() == b"4"
    assert [p.name for p in target.parent.iterdir()] == ["out"]


def test_an_interrupted_run_leaves_the_old_report(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, system: None
) -> None:
    target = tmp_path / "out"
    write_folder(target, {"a": b"old"})

    def interrupted(folder: Path, files: object, _: Path) -> None:
        (folder / "a").write_bytes(b"half")
        raise KeyboardInterrupt

    monkeypatch.setattr(folder_module, "_fill", interrupted)
    with pytest.raises(KeyboardInterrupt):
        write_folder(target, {"a": b"new"})
    assert (target / "a").read_bytes() == b"old"
    assert [p.name for p in tmp_path.iterdir()] == ["out"]


def test_a_failed_rename_puts_the_old_report_back(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "out"
    write_folder(target, {"a": b"old"})
    monkeypatch.setattr(folder_module, "_exchange", lambda *_: False)
    real = folder_module.os.rename

    def rename(a: Path, b: Path) -> None:
        if str(a).endswith(".partial"):
            raise OSError("disk trouble")
        real(a, b)

    monkeypatch.setattr(folder_module.os, "rename", rename)
    with pytest.raises(OSError, match="disk trouble"):
        write_folder(target, {"a": b"new"})
    assert (target / "a").read_bytes() == b"old"


@pytest.mark.parametrize("spoil", ["no manifest", "added", "changed", "other format", "link"])
def test_somebody_elses_files_are_not_replaced(tmp_path: Path, spoil: str) -> None:
    target = tmp_path / "out"
    write_folder(target, {"a": b"ours"})
    if spoil == "no manifest":
        (target / "manifest.json").unlink()
    elif spoil == "added":
        (target / "thesis.tex").write_text("mine")
    elif spoil == "changed":
        (target / "a").write_text("edited")
    elif spoil == "link":
        (target / "link").symlink_to(tmp_path)
    else:
        (target / "manifest.json").write_text("{}")
    before = names(target)
    with pytest.raises(FolderError, match="force"):
        write_folder(target, {"b": b"new"})
    assert names(target) == before
    write_folder(target, {"b": b"new"}, force=True)
    assert set(names(target)) >= {*before, "b"}


def test_a_file_is_not_a_folder(tmp_path: Path) -> None:
    (tmp_path / "f").write_text("x")
    with pytest.raises(FolderError, match="is a file"):
        write_folder(tmp_path / "f", {"a": b""}, force=True)


def test_an_empty_folder_is_anybodys(tmp_path: Path) -> None:
    (tmp_path / "e").mkdir()
    write_folder(tmp_path / "e", {"a": b"1"})
    assert names(tmp_path / "e") == ["a", "manifest.json"]


@pytest.mark.parametrize("name", ["../x", "/etc/x", "a/../../x"])
def test_no_file_lands_outside(tmp_path: Path, name: str) -> None:
    with pytest.raises(FolderError, match="outside"):
        write_folder(tmp_path / "out", {name: b""})
    assert not list(tmp_path.iterdir())
