"""`initial.time`, `schedule.epoch` and ISO 8601 times: exact, said, and never guessed."""

from fractions import Fraction as F

import pytest
from intermit.models.schedule import Window
from intermit.scenario.instants import moment

START = "2026-03-30T21:59:34Z"
ATTITUDE = "quaternion = [0.5, 0.5, 0.5, 0.5]"
EDGES = [(F("0.01"), F("3.21")), (F("8.01"), F("11.21")), (F("16.01"), F("19.21"))]


def table(shift=F(0)):
    pairs = (f"[{float(a + shift):.2f}, {float(b + shift):.2f}]" for a, b in EDGES)
    return f"windows = [{', '.join(pairs)}]"


@pytest.mark.parametrize(
    "text",
    [
        "2026-03-30T21:59:34Z",
        "2026-03-30 21:59:34",
        "2026-03-30T23:59:34+02:00",
        "2026-03-30T19:29:34 -0230",
        "2026-089T21:59:34.000Z",
        "2026-03-30T21:59:34,0 UTC",
    ],
)
def test_one_instant_has_many_spellings(text):
    days = 56 * 365 + 14 + 31 + 28 + 29  # 14 leap years between 1970 and 2026
    assert moment(text).seconds == ((days * 24 + 21) * 60 + 59) * 60 + 34


def test_fractions_of_a_second_are_exact():
    a, b = moment("2026-03-30T21:59:34.000000001Z"), moment("2026-03-30T21:59:34Z")
    assert a.seconds - b.seconds == F(1, 10**9)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("2026-03-30", "time of day"),
        ("2026-02-30T00:00Z", "is no time"),
        ("2025-366T00:00Z", "no day 366"),
        ("2016-12-31T23:59:60Z", "leap seconds"),
        ("2026-03-30T21:59:34+25:00", "no zone"),
        ("2026-03-30T24:30Z", "is no time"),
    ],
)
def test_what_is_no_time_is_refused(text, words):
    with pytest.raises(ValueError, match=words):
        moment(text)


@pytest.mark.parametrize("text", ["12.5", "on", "1e-05", "-3"])
def test_numbers_and_names_are_no_dates(text):
    assert moment(text) is None


@pytest.mark.parametrize("shift", [F(1000), F(10**6), F(1_760_000_000)])
def test_a_table_and_its_start_moved_together_are_the_same(workshop, shift):
    still = workshop.load(simulation="horizon = 24", optimum="final_time = 22.5")
    moved = workshop.load(
        schedule=table(shift),
        initial=f"time = {shift}\n{ATTITUDE}",
        simulation=f"horizon = {24 + shift}",
        optimum=f"final_time = {float(shift + F('22.5')):.1f}",
    )
    assert moved.schedule == still.schedule
    assert (moved.horizon, moved.optimum.final_time) == (still.horizon, still.optimum.final_time)
    assert f"initial.time = {shift} s" in moved.clock.words
    assert not moved.warnings
    assert not still.clock.words


@pytest.mark.parametrize("turn", [0, 1, 10**6])
@pytest.mark.parametrize("form", ["windows = [[{on}, {off}]]", "on = {on}\non_time = 3.2"])
def test_a_periodic_table_is_turned_to_its_start(workshop, form, turn):
    still = workshop.load(schedule="on = 4.01\non_time = 3.2\nperiod = 8")
    first = F("0.01") + 1000  # the start, 4 s before a window, stands between two of them
    moved = workshop.load(
        schedule=form.format(on=float(first), off=float(first) + 3.2) + "\nperiod = 8",
        initial=f"time = {1004 - 8 + 8 * turn}\n{ATTITUDE}",
    )
    assert moved.schedule == still.schedule


def test_windows_before_the_start_are_left_out_and_said(workshop):
    scenario = workshop.load(initial=f"time = 8\n{ATTITUDE}")
    assert scenario.schedule.windows == tuple(Window(a - 8, b - 8) for a, b in EDGES[1:])
    assert any("1 window before the start left out" in warning for warning in scenario.warnings)


@pytest.mark.parametrize("period", ["", "\nperiod = 30"])
def test_a_start_inside_a_window_is_refused(workshop, period):
    text = workshop.complaint(schedule=table() + period, initial=f"time = 9\n{ATTITUDE}")
    assert "initial.time" in text
    assert "between two windows" in text


def test_a_start_after_the_last_window_is_refused(workshop):
    assert "every window has closed" in workshop.complaint(initial=f"time = 19.21\n{ATTITUDE}")


def test_a_late_first_window_names_the_remedy(workshop):
    scenario = workshop.load(schedule=table(F(1000)))
    assert any("give initial.time = 1000.01" in warning for warning in scenario.warnings)
    assert not workshop.load(schedule=table(F(10))).warnings


@pytest.mark.parametrize("key", ["simulation.horizon", "optimum.final_time"])
def test_an_end_before_the_start_is_refused(workshop, key):
    name, entry = key.split(".")
    text = workshop.complaint(**{name: f"{entry} = 60", "initial": f"time = 60\n{ATTITUDE}"})
    assert key in text
    assert "when the run starts" in text


def test_a_set_may_say_when_its_runs_start(workshop):
    scenario = workshop.load(initial="time = 8", initial_set="max_angle_deg = 120")
    assert scenario.initial.representative
    assert scenario.clock.start == 8


def test_dates_in_every_key(workshop):
    dated = [[f"2026-03-30T21:59:{34 + a:.2f}Z" for a in map(float, pair)] for pair in EDGES]
    still = workshop.load(simulation="horizon = 24", optimum="final_time = 20")
    moved = workshop.load(
        schedule=f'epoch = "{START}"\nwindows = {dated}'.replace("'", '"'),
        simulation='horizon = "2026-03-30T21:59:58Z"',
        optimum="final_time = 2026-03-30T21:59:54Z",
    )
    assert moved.schedule == still.schedule
    assert (moved.horizon, moved.optimum.final_time) == (24, 20)
    assert START in moved.clock.words
    assert not moved.warnings


def test_a_dated_start_is_an_epoch_of_its_own(workshop):
    still = workshop.load(simulation="horizon = 24")
    moved = workshop.load(initial=f'time = "{START}"\n{ATTITUDE}', simulation="horizon = 24")
    assert moved.schedule == still.schedule
    assert moved.horizon == 24


def csv(workshop, text, **tables):
    (workshop.folder / "w.csv").write_text(text, encoding="utf-8")
    return {"schedule": f'csv = "w.csv"\nepoch = "{START}"', **tables}


def test_dates_in_a_csv(workshop):
    rows = "2026-03-30T21:59:34.01,2026-03-30T21:59:37.21", "2026-03-30T21:59:42.01,2026-03-30T21:59:45.21"
    text = "\n".join(("on,off", *rows, ""))
    scenario = workshop.load(**csv(workshop, text))
    assert scenario.schedule.windows == tuple(Window(a, b) for a, b in EDGES[:2])
    assert any("read as UTC" in warning for warning in scenario.warnings)
    zoned = text.replace("1,", "1Z,").replace("1\n", "1Z\n")
    assert not workshop.load(**csv(workshop, zoned)).warnings


def test_dates_with_durations_in_a_csv(workshop):
    text = "on,duration_ms\n2026-03-30T21:59:34.01Z,3200\n2026-03-30T21:59:42.01Z,3200\n"
    scenario = workshop.load(**csv(workshop, text))
    assert scenario.schedule.windows == tuple(Window(a, b) for a, b in EDGES[:2])


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("on,off\n2026-03-30T21:59:34Z,9\n", "mixes dates and seconds"),
        ("on,off\n1,2\n2026-03-30T21:59:39Z,2026-03-30T21:59:40Z\n", "mixes dates and seconds"),
        ("on_ms,off_ms\n2026-03-30T21:59:34Z,2026-03-30T21:59:35Z\n", "remove the unit"),
        ("on,duration\n2026-03-30T21:59:34Z,2026-03-30T21:59:35Z\n", "expected a number under 'duration'"),
        ("on,off\n2026-03-30,2026-03-31\n", "time of day"),
    ],
)
def test_dates_that_could_mean_two_things_are_refused(workshop, text, words):
    assert words in workshop.complaint(**csv(workshop, text))


def test_a_date_without_an_epoch_names_the_remedy(workshop):
    text = "on,off\n2026-03-30T21:59:34Z,2026-03-30T21:59:38Z\n"
    complaint = workshop.complaint(**csv(workshop, text, schedule='csv = "w.csv"'))
    assert f'schedule.epoch = "{START}"' in complaint


@pytest.mark.parametrize(
    ("tables", "words"),
    [
        ({"schedule": f"epoch = 1760000000\n{table()}"}, "give initial.time"),
        ({"schedule": f'epoch = "soon"\n{table()}'}, "expected the date"),
        ({"initial": f'time = "soon"\n{ATTITUDE}'}, "expected a number"),
        ({"simulation": 'horizon = "2026-03-30T21:59:38Z"'}, "give schedule.epoch"),
    ],
)
def test_a_wrong_origin_names_its_key(workshop, tables, words):
    assert words in workshop.complaint(**tables)


def test_thrust_samples_move_with_their_start(workshop):
    def loaded(shift, start):
        rows = "".join(f"{t + shift},{x}\n" for t, x in ((0, 0), (1, 0), (2, 3), (3, 3), (4, 0), (9, 0)))
        (workshop.folder / "t.csv").write_text("time,thrust\n" + rows, encoding="utf-8")
        return workshop.load(
            schedule='[schedule.thrust]\ncsv = "t.csv"\nzero_below = 0',
            initial=f"time = {start}\n{ATTITUDE}",
        )

    assert loaded(10**6, 10**6).schedule == loaded(0, 0).schedule
    late = loaded(10**6, 10**6 + 0.5)
    assert late.schedule.windows == (Window(F(1, 2), F(7, 2)),)
