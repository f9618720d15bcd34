"""The parts of every law are done once each, here or elsewhere; what fails elsewhere is raised here."""

import threading
from fractions import Fraction
from multiprocessing.pool import ThreadPool
from time import sleep
from types import SimpleNamespace

import pytest
from intermit.study.check import workers as jobs
from intermit.study.check.case import CaseOptions, Decided
from intermit.study.simulated_run import RunFigures

LAWS = [SimpleNamespace(label=f"law {n}") for n in range(5)]


def run(others, monkeypatch, **replaced):
    """Findings of five laws by parts that only say what they were asked, and who did what."""
    done = []

    def proofs(scenario, law, seen, options, tell=None):
        done.append(("proofs", law.label, threading.current_thread()))
        sleep(0.01)
        number = int(law.label[-1])
        return Decided((), Fraction(number), None, f"note {number}", number % 2 == 0)

    def margins(scenario, law):
        done.append(("margins", law.label, threading.current_thread()))
        return ()

    def samples(scenario, law, floor, progress):
        assert floor == int(law.label[-1])
        done.append(("samples", law.label, threading.current_thread()))
        progress(1.0)
        return None, "of a reason"

    parts = {"proofs": proofs, "margins": margins, "samples": samples} | replaced
    for name, part in parts.items():
        monkeypatch.setitem(jobs.PARTS, name, part)
    told = []
    with ThreadPool(max(others, 1)) as pool:
        crew = jobs.WorkerPool(
            pool if others else None, others, len(LAWS), lambda stage, share: told.append((stage, share))
        )
        for law in LAWS:
            crew.add(None, law, RunFigures(), CaseOptions())
        found = crew.findings()
    assert all(0 <= share <= 1 for _, share in told)
    return found, done


@pytest.mark.parametrize("others", [0, 1, 3])
def test_every_part_is_done_once_in_the_laws_order(others, monkeypatch):
    found, done = run(others, monkeypatch)
    assert [f.reference_floor for f in found] == [0, 1, 2, 3, 4]
    assert found[3].notes == ("note 3", "V' was not sampled: of a reason")
    asked = sorted((part, label) for part, label, _ in done)
    expected = [(p, law.label) for law in LAWS for p in ("proofs", "samples")]
    expected += [("margins", LAWS[n].label) for n in (0, 2, 4)]
    assert asked == sorted(expected)
    assert ({t for *_, t in done} == {threading.main_thread()}) == (others == 0)


@pytest.mark.parametrize("others", [0, 1, 3])
def test_a_failure_anywhere_ends_the_check(others, monkeypatch):
    def broken(*arguments):
        raise ArithmeticError("lost")

    with pytest.raises(ArithmeticError, match="lost"):
        run(others, monkeypatch, margins=broken)
