"""What the tables mean: forms that agree, inheritance, target, sets, user laws, the hash, the template."""

from fractions import Fraction

import numpy as np
import pytest
from intermit.scenario import (
    TEMPLATE,
    ScenarioError,
    law_from_words,
    load_scenario,
    with_laws,
    write_examples,
    write_template,
)

ZERO = Fraction(0)


def test_period_table_and_csv_agree(workshop):
    (workshop.folder / "w.csv").write_text("on [s], off [s]\n0.01, 3.21\n8.01, 11.21  # second\n")
    forms = [
        "windows = [[0.01, 3.21], [8.01, 11.21]]\nperiod = 16",
        'csv = "w.csv"\nperiod = 16',
        "period = 8\non = 0.01\non_time = 3.2",
    ]
    times = [Fraction(k, 3) for k in range(100)]
    first, *others = (workshop.load(schedule=form).schedule for form in forms)
    for other in others:
        assert [other.square_integral(ZERO, t) for t in times] == [
            first.square_integral(ZERO, t) for t in times
        ]


def test_count_ends_the_windows(workshop):
    schedule = workshop.load(schedule="period = 8\non = 0.01\non_time = 3.2\ncount = 3").schedule
    assert not schedule.is_periodic
    assert [w.on for w in schedule.windows] == [Fraction("0.01"), Fraction("8.01"), Fraction("16.01")]
    assert schedule.square_integral(Fraction(24), Fraction(100)) == 0


def test_horizon_defaults(workshop):
    assert workshop.load(schedule="period = 8\non_time = 3").horizon == 56
    assert workshop.load(schedule="windows = [[1, 2], [5, 6]]").horizon == 6
    assert workshop.load(schedule="windows = [[1, 2], [5, 6]]\nperiod = 7").horizon == 7
    assert workshop.load(schedule="period = 8\non_time = 3\ncount = 500").horizon == 99 * 8 + 3
    assert workshop.load(simulation="horizon = 12.5").horizon == Fraction(25, 2)


def test_target_turns_the_start(workshop):
    """Start and target turned by the same rotation: the error stays the same."""
    error = workshop.load(initial="axis = [1, 2, 3]\nangle_deg = 50").initial.quaternion
    target = np.array([0.8, 0.0, 0.6, 0.0])
    b0 = target[0] * error[0] - target[1:] @ error[1:]
    bv = target[0] * error[1:] + error[0] * target[1:] + np.cross(target[1:], error[1:])
    start = ", ".join(f"{float(x):.12f}" for x in (b0, *bv))
    moved = workshop.load(initial=f"quaternion = [{start}]", target="quaternion = [0.8, 0, 0.6, 0]")
    assert moved.initial.quaternion == pytest.approx(error, abs=2e-12)


def test_quaternion_sign_is_kept(workshop):
    """(b0, bv) and its negative are one attitude but two starts: 2 acos b0 tells them apart."""
    assert workshop.load(initial="quaternion = [0.5, 0.5, 0.5, 0.5]").initial.angle_deg == pytest.approx(120)
    other = workshop.load(initial="quaternion = [-0.5, -0.5, -0.5, -0.5]")
    assert other.initial.angle_deg == pytest.approx(240)
    assert other.warnings


def test_set_from_state_holds_the_state(workshop):
    scenario = workshop.load(initial="quaternion = [0.6, 0.8, 0, 0]\nrate = [0.1, 0.2, -0.3]")
    bounds, rate = scenario.initial_set, scenario.initial.exact_rate
    assert bounds.from_state
    assert bounds.max_rate**2 >= sum(x * x for x in rate)
    assert float(bounds.max_rate) == pytest.approx(np.sqrt(0.14), rel=1e-15)
    assert 0 < float(bounds.max_angle_deg) - np.degrees(2 * np.arccos(0.6)) < 2e-9


def test_state_from_set_lies_on_its_edge(workshop):
    scenario = workshop.load(initial=None, initial_set="max_angle_deg = 90\nmax_rate = 0.1")
    assert scenario.initial.representative
    assert scenario.initial.angle_deg == pytest.approx(90)
    assert not scenario.initial_set.from_state


def test_extends_replaces_whole_tables_but_merges_defaults(workshop):
    law = '[[law]]\ntype = "persistence-filter"\n'
    workshop.write(name="base.toml", law=None, law_defaults="lambda = 0.5\nR0 = 1")
    path = workshop.folder / "child.toml"
    path.write_text(f'extends = "base.toml"\n[law_defaults]\nR0 = 2\n[schedule]\nwindows = [[1, 2]]\n{law}')
    scenario = load_scenario(path)
    assert dict(scenario.laws[0].parameters) == {"lambda": Fraction(1, 2), "R0": Fraction(2)}
    assert len(scenario.schedule.windows) == 1


def test_other_laws_leave_the_front_those_it_still_has(workshop):
    laws = 'type = "persistence-filter"\nlambda = 0.5\nR0 = 1\nlabel = "{}"'
    front = 'front = [20]\nfront_laws = ["first"]'
    workshop.write(name="base.toml", law=laws.format("first"), report=front)
    path = workshop.folder / "child.toml"
    for label, kept in (("first", ("first",)), ("second", ())):
        path.write_text(f'extends = "base.toml"\n[[law]]\n{laws.format(label)}\n')
        report = load_scenario(path).report
        assert report.front_laws == kept
        assert bool(report.front) == bool(kept)
    wrong = "report.front_laws: has no law labelled 'first'"
    assert wrong in workshop.complaint(law=laws.format("second"), report=front)
    path.write_text(f'extends = "base.toml"\n[[law]]\n{laws.format("second")}\n[report]\n{front}\n')
    with pytest.raises(ScenarioError, match="has no law labelled 'first'"):
        load_scenario(path)


def test_errors_name_the_file_that_holds_the_key(workshop):
    workshop.write(name="base.toml", initial="quaternion = [1, 1, 0, 0]")
    path = workshop.folder / "child.toml"
    path.write_text('extends = "base.toml"\n')
    with pytest.raises(ScenarioError, match=r"^base\.toml: initial\.quaternion: must be a unit quaternion"):
        load_scenario(path)


def test_extends_in_a_circle(workshop):
    (workshop.folder / "a.toml").write_text('extends = "b.toml"')
    (workshop.folder / "b.toml").write_text('extends = "a.toml"')
    with pytest.raises(ScenarioError, match="extends a file that extends it in turn"):
        load_scenario(workshop.folder / "a.toml")


def test_hash_follows_the_meaning(workshop):
    base = workshop.load().sha256
    assert workshop.load(head="# a remark").sha256 == base
    assert workshop.load(initial="quaternion = [0.50, 0.5, 0.5, 5e-1]").sha256 == base
    assert workshop.load(initial="quaternion = [0.5, 0.5, 0.5, -0.5]").sha256 != base
    assert workshop.load(head='name = "x"').sha256 != base
    (workshop.folder / "w.csv").write_text("0,3\n")
    first = workshop.load(schedule='csv = "w.csv"').sha256
    (workshop.folder / "w.csv").write_text("0,3.5\n")
    assert workshop.load(schedule='csv = "w.csv"').sha256 != first


def test_inertia_tolerance_is_exact_and_spread(workshop):
    J = "inertia = [[3, 0, 0], [0, 3, 0], [0, 0, 2]]"
    one = workshop.load(spacecraft=f"{J}\ninertia_tolerance = 0.10")
    assert one.inertia_tolerance == ((Fraction(1, 10),) * 3,) * 3
    same = workshop.load(spacecraft=f"{J}\ninertia_tolerance = 0.1")
    assert one.sha256 == same.sha256
    rows = workshop.load(spacecraft=f"{J}\ninertia_tolerance = [[0.1, 0, 0], [0, 0.2, 0], [0, 0, 0.3]]")
    assert rows.inertia_tolerance[1][1] == Fraction(1, 5)


USER_LAW = '''
from dataclasses import dataclass
from fractions import Fraction
from intermit.models.laws import Control, Law

@dataclass(frozen=True)
class Mine(Law):
    """Mine."""
    name = "mine"
    stiffness: Fraction

    def control(self, plant, time, states, parameters):
        return Control(-parameters["stiffness"] * plant.bv)

class NotALaw:
    pass
'''


PRODUCTS = "inertia_moments = [3.05, 2.66, 2.18]\ninertia_products = {{ xy = {xy}, xz = -0.05, yz = -0.12 }}"


def test_products_of_inertia_are_minus_the_entries(workshop):
    rows = "inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]"
    matrix = workshop.load(spacecraft=rows).body.exact_inertia
    assert workshop.load(spacecraft=PRODUCTS.format(xy="-0.14")).body.exact_inertia == matrix
    assert workshop.load(spacecraft=PRODUCTS.format(xy="0.14")).body.exact_inertia != matrix


@pytest.mark.parametrize(
    ("table", "says"),
    [
        (PRODUCTS.format(xy="0") + "\ninertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]", "given twice"),
        ("inertia_moments = [1, 1, 1]", "inertia_products: required"),
        ("inertia_moments = [1, 1, 1]\ninertia_products = [0, 0, 0]", "inertia_products: expected a table"),
        ("name = 'none'", "inertia: required"),
    ],
)
def test_an_inertia_is_given_once_and_whole(workshop, table, says):
    assert says in workshop.complaint(spacecraft=table)


@pytest.mark.parametrize(
    ("start", "says"),
    [
        ("quaternion = [0, 0.6, 0, 0.8]", ""),
        ("quaternion = [0.01, 0, 0, 0.99995]", "a turn of 178.854 deg; if the scalar stands last"),
        ("axis = [1, 0, 0]\nangle_deg = 9\nrate = [5, 0, 0]", "5 rad/s are 286.479 deg/s"),
        ("axis = [1, 0, 0]\nangle_deg = 9\nrate = [0.9, 0, 0]", ""),
    ],
)
def test_a_start_in_a_doubtful_unit_or_order_is_spelled_out(workshop, start, says):
    warnings = [w for w in workshop.load(initial=start).warnings if "initial" in w]
    assert bool(warnings) == bool(says)
    assert all(says in w for w in warnings)


def test_user_law_is_loaded_with_exact_parameters(workshop):
    (workshop.folder / "mine.py").write_text(USER_LAW)
    text = 'type = "user"\nfile = "mine.py"\nclass = "{}"\nparameters = {{ {} = 0.1 }}'
    law = workshop.load(law=text.format("Mine", "stiffness")).laws[0].build()
    assert law.parameters == {"stiffness": Fraction(1, 10)}
    for name, key, message in (
        ("Mine", "stifness", "scenario.toml: law[1].parameters: Mine: "),
        ("NotALaw", "stiffness", "scenario.toml: law[1].class: 'NotALaw' must be a subclass of"),
        ("Absent", "stiffness", "scenario.toml: law[1].class: mine.py has no class 'Absent'"),
    ):
        choice = workshop.load(law=text.format(name, key)).laws[0]
        with pytest.raises(ScenarioError) as caught:
            choice.build()
        assert str(caught.value).startswith(message)


@pytest.mark.parametrize(
    ("source", "message"),
    [
        ("x = 1\n1/0\n", "mine.py line 2: cannot be run: ZeroDivisionError: division by zero"),
        ("def (", "mine.py line 1: cannot be run: SyntaxError"),
        (None, "mine.py: no such file"),
    ],
)
def test_user_law_that_cannot_be_run(workshop, source, message):
    if source is not None:
        (workshop.folder / "mine.py").write_text(source)
    choice = workshop.load(law='type = "user"\nfile = "mine.py"\nclass = "Mine"').laws[0]
    with pytest.raises(ScenarioError) as caught:
        choice.build()
    assert str(caught.value).startswith(f"scenario.toml: law[1].file: {message}")
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("torque", "message"),
    [
        ("plant.w * ca.SX.sym('zz')", "law mine uses the symbol zz, which is none of those it was given"),
        ("plant.b0", "law mine: the torque must have shape (3,), received (1, 1)"),
        ("parameters['gain'] * plant.w", "'gain'"),
        ("ca.mtimes(plant.w, plant.w)", "incompatible dimension"),
    ],
)
def test_user_law_whose_torque_is_none(workshop, torque, message):
    source = USER_LAW.replace('-parameters["stiffness"] * plant.bv', torque)
    (workshop.folder / "mine.py").write_text("import casadi as ca\n" + source)
    text = 'type = "user"\nfile = "mine.py"\nclass = "Mine"\nparameters = { stiffness = 1 }'
    with pytest.raises(ScenarioError) as caught:
        workshop.load(law=text).laws[0].build()
    assert str(caught.value).startswith("scenario.toml: law[1].class: mine.py")
    assert "Mine" in str(caught.value)
    assert message in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_law_named_on_the_command_line_joins_the_others(workshop):
    (workshop.folder / "mine.py").write_text(USER_LAW)
    scenario = workshop.load()
    choice = law_from_words(f"{workshop.folder}/mine.py:Mine, stiffness=0.1,label=soft")
    more = with_laws(scenario, choice)
    assert [law.label for law in more.laws] == ["persistence-filter", "soft"]
    assert more.laws[1].build().parameters == {"stiffness": Fraction(1, 10)}
    assert more.sha256 != scenario.sha256
    other = with_laws(scenario, law_from_words(f"{workshop.folder}/mine.py:Mine,stiffness=0.2,label=soft"))
    assert other.sha256 != more.sha256
    with pytest.raises(ScenarioError, match="is taken"):
        with_laws(more, choice)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        ("mine.py", "law 'mine.py': expected FILE:CLASS, or FILE:CLASS,name=value,..."),
        (":Mine", "law ':Mine': expected FILE:CLASS, or FILE:CLASS,name=value,..."),
        ("mine.py:a b", "law 'mine.py:a b': expected FILE:CLASS, or FILE:CLASS,name=value,..."),
        ("mine.py:Mine,k", "law 'mine.py:Mine,k': expected name=value, received 'k'"),
        ("mine.py:Mine,k=x", "law 'mine.py:Mine,k=x': k: expected a number, received 'x'"),
        ("mine.py:Mine,k=nan", "law 'mine.py:Mine,k=nan': k: expected a finite number, received 'nan'"),
    ],
)
def test_words_that_name_no_law(words, message):
    with pytest.raises(ScenarioError) as caught:
        law_from_words(words)
    assert str(caught.value) == message


def test_labels_are_unique(workshop):
    law = SOUND_LAW + "\n[[law]]\n" + SOUND_LAW
    assert "is used twice" in workshop.complaint(law=law)
    scenario = workshop.load(law=SOUND_LAW + '\n[[law]]\nlabel = "other"\n' + SOUND_LAW)
    assert dict(scenario.law("other").parameters)["R0"] == 1
    with pytest.raises(ScenarioError, match="has no law labelled 'third'"):
        scenario.law("third")


SOUND_LAW = 'type = "persistence-filter"\nlambda = 0.525\nR0 = 1'


def test_template_loads_and_is_never_overwritten(tmp_path):
    path = write_template(tmp_path / "new.toml")
    assert path.read_text() == TEMPLATE
    assert load_scenario(path).warnings == ()
    with pytest.raises(ScenarioError, match="exists already"):
        write_template(path)


def test_every_commented_key_of_the_template_is_known(tmp_path):
    """Uncommenting a commented table, or a single key, may conflict but never names an unknown key."""
    paragraphs = TEMPLATE.split("\n\n")
    variants = 0
    for i, paragraph in enumerate(paragraphs[1:], start=1):
        whole_table = paragraph.startswith("# [")
        lines = paragraph.splitlines()
        commented = [n for n, line in enumerate(lines) if line.startswith("# ")]
        for chosen in [commented] if whole_table else [[n] for n in commented]:
            text = "\n".join(line[2:] if n in chosen else line for n, line in enumerate(lines))
            path = tmp_path / "one.toml"
            path.write_text("\n\n".join([*paragraphs[:i], text, *paragraphs[i + 1 :]]))
            variants += 1
            try:
                load_scenario(path)
            except ScenarioError as error:
                problem = str(error)
            else:
                problem = ""
            assert "unknown key" not in problem, text
            assert "TOML" not in problem, text
    assert variants > 8


def test_examples_are_written_and_load(tmp_path):
    written = write_examples(tmp_path / "here")
    for path in written:
        if path.suffix == ".toml":
            load_scenario(path)
    with pytest.raises(ScenarioError, match="exists already"):
        write_examples(tmp_path / "here")
