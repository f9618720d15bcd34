"""Every outcome of the command line is one exit code, and every error one line without a traceback."""

from __future__ import annotations

import os
import subprocess
import sys
from types import SimpleNamespace

import intermit
import pytest
from intermit.cli import app as frame
from intermit.cli.exit_codes import ExitCode
from intermit.errors import InputError
from intermit.reports import RecordError
from intermit.reports.folder import FolderError
from intermit.scenario import ScenarioError

HEAVY = (
    "numpy",
    "scipy",
    "casadi",
    "cvxpy",
    "clarabel",
    "matplotlib",
    "flint",
    "pydantic_core",
    "rich.table",
)


def outcome(monkeypatch: pytest.MonkeyPatch, action: object, *arguments: str) -> int:
    """Exit code of a command line whose only command does `action`."""

    def run() -> int | None:
        """Act."""
        return action()  # type: ignore[operator, no-any-return]

    monkeypatch.setattr(frame, "COMMANDS", ("act",))
    monkeypatch.setattr(frame, "import_module", lambda *_: SimpleNamespace(run=run))
    return frame.run(["act", *arguments])


def raising(error: BaseException) -> object:
    def action() -> None:
        raise error

    return action


@pytest.mark.parametrize(
    ("action", "code"),
    [
        (lambda: None, 0),
        (lambda: ExitCode.REFUTED, 1),
        (lambda: ExitCode.UNDECIDED, 3),
        (raising(InputError("scenario.toml: law.lambda: must be > 0, received -1")), 2),
        (raising(FileNotFoundError(2, "No such file or directory", "missing.toml")), 2),
        (raising(RuntimeError("optimum below its certified bound")), 70),
        (raising(KeyboardInterrupt()), 130),
    ],
)
def test_outcome_has_its_exit_code(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str], action: object, code: int
) -> None:
    assert outcome(monkeypatch, action) == code
    errors = capfd.readouterr().err
    assert errors.count("\n") == (0 if code in (0, 1, 3) else 1)
    assert "Traceback" not in errors


def test_errors_are_told_by_their_base_and_not_by_their_name(monkeypatch: pytest.MonkeyPatch) -> None:
    for kind in (ScenarioError, RecordError, FolderError):
        assert issubclass(kind, intermit.InputError)
    namesake = type("ScenarioError", (ValueError,), {})
    assert outcome(monkeypatch, raising(ScenarioError("scenario.toml: law.lambda", "must be > 0"))) == 2
    assert outcome(monkeypatch, raising(namesake("not the user's"))) == ExitCode.INTERNAL


def test_debug_shows_the_traceback(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(frame, "COMMANDS", ())
    assert frame.run(["--debug", "nonsense"]) == ExitCode.BAD_INPUT
    assert "Traceback" in capfd.readouterr().err


def test_message_stays_on_one_line(
    monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    outcome(monkeypatch, raising(InputError("a name with\na break\x1b[31m in it")))
    assert capfd.readouterr().err == "intermit: a name with a break [31m in it\n"


def test_unknown_option_is_bad_input(capfd: pytest.CaptureFixture[str]) -> None:
    assert frame.run(["--nonsense"]) == ExitCode.BAD_INPUT
    assert capfd.readouterr().err.count("\n") == 1


def test_the_command_line_keeps_to_one_blas_thread_unless_told(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(os, "environ", {**os.environ, "OMP_NUM_THREADS": "3"})
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    monkeypatch.setattr(frame, "run", lambda _: 0)
    with pytest.raises(SystemExit, match="0"):
        frame.main([])
    assert os.environ["OPENBLAS_NUM_THREADS"] == "1"
    assert os.environ["OMP_NUM_THREADS"] == "3"


def test_help_and_version_load_nothing_heavy() -> None:
    """What takes 0.3 s is imports; they are counted, not timed."""
    program = (
        "import sys; from intermit.cli.app import run; code = run(['--help']) or run(['--version']); "
        f"heavy = [m for m in {HEAVY!r} if m in sys.modules]; sys.exit(str(heavy) if heavy else code)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert "Exit codes: 0" in done.stdout
