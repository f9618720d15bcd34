"""Nothing false about the least peak passes the checker: mutants, hostile witnesses, its arithmetic."""

import copy
import json
import math
import random
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds.argument import NamedBound, PathArgument
from intermit.optim.bounds.certificate import peak_certificate
from intermit.optim.bounds.potential.path import PathBound
from intermit.optim.bounds.potential.prove import BranchAndBound
from intermit.optim.bounds.potential.separation import Target, proved_separation
from intermit.optim.bounds.prepare import Prepared
from intermit.optim.bounds.proof import best_departure
from intermit.optim.bounds.sets.chart import arc_to_identity, chart_between
from intermit.optim.bounds.sets.gauge import invariant_set
from intermit.optim.bounds.sets.momentum_sets import UnitBall
from intermit.optim.bounds.sets.polynomials import AXES, RING
from intermit.optim.bounds.windows.travel import least_peak
from intermit.optim.peak import MultiStart, Refinement, minimum_peak
from intermit.optim.problem import Terminal, TransferProblem, quaternion_from_axis_angle
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.checker import check_text

LONG = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
WINDOW = PiecewisePolynomial(
    (Fraction(0), Fraction(4), Fraction(6), Fraction(10)), ((Fraction(1),), (), (Fraction(1),))
)
WITNESS = ("certificates", 0, "witness")
PROOF = (*WITNESS, "separations", 0)
BULK = 200
"""How many numbers of the potential are changed; a tenth of it where the rest is the claim."""
COARSE = Refinement(mesh_gap=1e-2)
"""Any transfer flown will do: its peak is above the optimum's."""


TUMBLING = (Fraction("0.03"), Fraction("-0.05"), Fraction("0.02"))


def problem(norm, rate=(Fraction(0),) * 3):
    turn = quaternion_from_axis_angle((1, 1, 1), math.radians(60))
    return TransferProblem(body=LONG, window=WINDOW, attitude=turn, rate=rate, norm=norm)


def bound_by_a_linear_potential(case):
    """A weak bound that takes no fitting: its certificate has all that the best one has."""
    ball = case.norm.is_ball
    momenta = UnitBall(case.body) if ball else invariant_set(case.body, case.norm)
    measured = Prepared(case).measured(momenta)
    departure = best_departure(measured)
    q = departure.coast.attitude
    arc = arc_to_identity(np.array([float(c) for c in q]) / float(sum(c * c for c in q)) ** 0.5)
    chart = chart_between(q, 1.6 * arc)
    along = {e: c / 100 for e, c in random_cubic(3, 4).items() if sum(e) > 1}
    along |= dict(zip(AXES, chart.direction, strict=True))
    found = proved_separation(
        case.body,
        q,
        Target(),
        momenta,
        chart,
        RING.polynomial(along),
        BranchAndBound(tolerance=1e-2, most_boxes=20_000),
    )
    assert found.travel > 0
    path = PathBound(found.travel, ((1, found), (-1, None)))
    peak = least_peak(
        measured.prepared.windows, path.travel - departure.slack, measured.start[1], Fraction(0),
        after=departure.coast.until, deviation=departure.deviation,
    )  # fmt: skip
    assert peak.value > 0
    return NamedBound("path", peak.value, PathArgument(measured, path, departure, peak.instant))


CASES = {
    "ball": problem(EUCLIDEAN),
    "invariant set": problem(LARGEST_COMPONENT),
    "ball, after a coast": problem(EUCLIDEAN, TUMBLING),
    "invariant set, after a coast": problem(LARGEST_COMPONENT, TUMBLING),
}


@pytest.fixture(scope="module", params=CASES)
def document(request):
    case = CASES[request.param]
    text = certificate_text([peak_certificate(case, bound_by_a_linear_potential(case))])
    assert ("coast" in text) == ("coast" in request.param)
    assert all(f.valid for f in check_text(text))
    return json.loads(text)


def leaves(value, path=()):
    members = value.items() if isinstance(value, dict) else enumerate(value)
    for key, one in members:
        if isinstance(one, (dict, list)):
            yield from leaves(one, (*path, key))
        else:
            yield (*path, key), one


def changed(document, path, value):
    result = copy.deepcopy(document)
    place = result["parts"][0]
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    return result


def accepted(document):
    return all(f.valid for f in check_text(json.dumps(document)))


def stated_problem(document):
    """The transfer of a file, read by other code than the checker's."""
    data = document["parts"][0]["data"]
    place = data["transfer"]
    norm = {"euclidean": EUCLIDEAN, "component": LARGEST_COMPONENT}[place["torque"]["by"]]
    window = PiecewisePolynomial(
        tuple(Fraction(k) for k in place["window"]["knots"]),
        tuple(tuple(Fraction(c) for c in shape) for shape in place["window"]["shapes"]),
    )
    return TransferProblem(
        body=RigidBody.from_rows(data["inertia"]),
        window=window,
        attitude=tuple(Fraction(c) for c in place["attitude"]),
        rate=tuple(Fraction(c) for c in place["rate"]),
        norm=norm,
        terminal=Terminal(
            Fraction(place["tolerance"]["attitude"]), rate=Fraction(place["tolerance"]["rate"])
        ),
        signs=tuple(int(s) for s in place["signs"]),
    )


@pytest.mark.slow
def test_every_mutant_is_refused_or_true(document):
    """Each scalar, some of the many: what passes claims the same, less, or what no transfer denies."""
    rng = random.Random(8)
    original = Fraction(document["parts"][0]["certificates"][0]["claim"]["peak"])
    paths = list(leaves(document["parts"][0]))
    bulk = [entry for entry in paths if "potential" in entry[0]]
    numbers = [entry for entry in paths if "potential" not in entry[0]]
    coasting = "coast" in document["parts"][0]["certificates"][0]["witness"]
    assert len(numbers) > (48 if coasting else 40)
    passed = 0
    for path, text in numbers + [rng.choice(bulk) for _ in range(BULK // 10 if coasting else BULK)]:
        if text[0].isalpha():
            assert not accepted(changed(document, path, text + "s"))
            continue
        x = Fraction(text)
        factor = 1 + rng.choice((-1, 1)) * Fraction(rng.randint(1, 10), rng.choice((10, 1000)))
        mutant = changed(document, path, str(x * factor if x else Fraction(rng.choice((-1, 1)), 50)))
        if not accepted(mutant) or (path[0] == "certificates" and "claim" not in path):
            continue  # with another witness the claim is still that of the original
        claim = Fraction(mutant["parts"][0]["certificates"][0]["claim"]["peak"])
        passed += 1
        if path[0] == "certificates":
            assert claim <= original
        else:
            answer = minimum_peak(
                stated_problem(mutant), search=MultiStart(starts=1, seed=1), refinement=COARSE
            )
            assert answer.history is None or float(claim) <= answer.peak * (1 + 1e-7), path
    assert passed > 0


HOSTILE = {
    "a peak of zero": (("certificates", 0, "claim", "peak"), "0"),
    "a negative peak": (("certificates", 0, "claim", "peak"), "-1"),
    "a peak that is no number": (("certificates", 0, "claim", "peak"), "nan"),
    "an infinite peak": (("certificates", 0, "claim", "peak"), "inf"),
    "a huge peak": (("certificates", 0, "claim", "peak"), "1e9999"),
    "a negative travel": ((*WITNESS, "travel"), "-1"),
    "a huge travel": ((*WITNESS, "travel"), "1e9999"),
    "a split before the start": ((*WITNESS, "instant"), "-1"),
    "a split after the end": ((*WITNESS, "instant"), "11"),
    "a negative size of the end": ((*WITNESS, "end"), "-1"),
    "another argument": ((*WITNESS, "argument"), "momentum"),
    "an unknown argument": ((*WITNESS, "argument"), "faith"),
    "no rows": ((*WITNESS, "rows"), []),
    "a row that is no size": ((*WITNESS, "rows", 0), ["-1", "0"]),
    "a row of nothing": ((*WITNESS, "rows", 0), ["0", "0"]),
    "an indefinite row": ((*WITNESS, "rows", 0), ["-0.4", "1"]),
    "a negative multiplier": ((*WITNESS, "speed", 0), "-1"),
    "no multiplier": ((*WITNESS, "speed", 0), "0"),
    "too many multipliers": ((*WITNESS, "speed"), ["1"] * 7),
    "no separations": ((*WITNESS, "separations"), []),
    "separation by assertion": ((*PROOF, "by"), "word"),
    "a negative rate": ((*PROOF, "rate"), "-1"),
    "a rate of zero": ((*PROOF, "rate"), "0"),
    "no potential": ((*PROOF, "potential"), []),
    "a term given twice": ((*PROOF, "potential", 1), ["1", "0", "0", "5"]),
    "a constant term": ((*PROOF, "potential", 1), ["0", "0", "0", "5"]),
    "a negative exponent": ((*PROOF, "potential", 0, 0), "-1"),
    "a degree beyond any use": ((*PROOF, "potential", 0, 0), "5000"),
    "half an exponent": ((*PROOF, "potential", 0, 0), "1/2"),
    "a direction of no length": ((*PROOF, "chart", "direction"), ["0", "0", "0"]),
    "a chart beyond its sphere": ((*PROOF, "chart", "outer"), "1"),
    "a chart of no size": ((*PROOF, "chart", "outer"), "0"),
    "an inner arc beyond the outer": ((*PROOF, "chart", "inner"), "0.9"),
    "a middle far away": ((*PROOF, "chart", "middle", 0), "1e300"),
    "a degenerate inertia": (("data", "inertia"), [["1", "1", "0"], ["1", "1", "0"], ["0", "0", "1"]]),
    "no inertia at all": (("data", "inertia"), [["0"] * 3] * 3),
    "a negative inertia": (("data", "inertia", 0, 0), "-3.05"),
    "an inertia not symmetric": (("data", "inertia", 0, 1), "0.15"),
    "no quaternion": (("data", "transfer", "attitude"), ["0"] * 4),
    "the other quaternion's start": (("data", "transfer", "signs"), ["-1", "1"]),
    "no target": (("data", "transfer", "signs"), []),
    "a target twice": (("data", "transfer", "signs"), ["1", "1"]),
    "a target of no sign": (("data", "transfer", "signs"), ["1", "0"]),
    "a target everywhere": (("data", "transfer", "tolerance", "attitude"), "1"),
    "a negative tolerance": (("data", "transfer", "tolerance", "attitude"), "-0.1"),
    "a negative terminal rate": (("data", "transfer", "tolerance", "rate"), "-0.1"),
    "windows that never open": (("data", "transfer", "window", "shapes"), [[], [], []]),
    "a window below zero": (("data", "transfer", "window", "shapes", 1), ["-0.001"]),
    "a window that dips below zero": (("data", "transfer", "window", "shapes", 0), ["1", "-5", "5"]),
    "a profile scaled": (("data", "transfer", "window", "shapes", 0), ["1.01"]),
    "knots that run back": (("data", "transfer", "window", "knots", 1), "7"),
    "no time": (("data", "transfer", "window"), {"knots": ["0"], "shapes": []}),
    "a later end": (("data", "transfer", "window", "knots", 3), "10.5"),
    "a later start": (("data", "transfer", "window", "knots", 0), "1"),
    "thrusters without axes": (("data", "transfer", "torque"), {"by": "thrusters", "axes": []}),
    "an unknown limit": (("data", "transfer", "torque"), {"by": "wish"}),
    "a field that nothing reads": (("data", "transfer", "torque", "axes"), [["1", "0", "0"]]),
    "a field of the witness that nothing reads": ((*WITNESS, "box"), ["1", "1", "1"]),
}


COAST = (*WITNESS, "coast")
HOSTILE_COASTS = {
    "a coast of no time": ((*COAST, "until"), "0"),
    "a coast into the past": ((*COAST, "until"), "-1"),
    "a coast beyond the end": ((*COAST, "until"), "11"),
    "a coast for ever": ((*COAST, "until"), "1e300"),
    "nowhere": ((*COAST, "attitude"), ["0"] * 4),
    "the target at once": ((*COAST, "attitude"), ["1", "0", "0", "0"]),
    "the coast not followed": ((*COAST, "attitude"), [str(c) for c in CASES["ball"].attitude]),
    "no allowance for the turn": ((*COAST, "turn"), "0"),
    "a negative turn": ((*COAST, "turn"), "-1"),
    "a turn that costs nothing": ((*COAST, "slack"), "0"),
    "a negative slack": ((*COAST, "slack"), "-1"),
    "deviations that do not grow": ((*COAST, "growth"), ["0", "0"]),
    "deviations that shrink": ((*COAST, "growth", 0), "-1"),
    "deviations out of bounds": ((*COAST, "growth", 1), "1e9"),
    "a split during the coast": ((*WITNESS, "instant"), "0.01"),
    "another start": (("data", "transfer", "rate", 1), "-0.051"),
    "another start, tumbling the other way": (("data", "transfer", "rate"), ["-0.03", "0.05", "-0.02"]),
    "a start of no length to speak of": (("data", "transfer", "attitude"), ["1e-30"] * 4),
    "a start that spins": (("data", "transfer", "rate"), ["300", "-500", "200"]),
}


@pytest.mark.parametrize("document", [key for key in CASES if "coast" in key], indirect=True)
@pytest.mark.parametrize("what", HOSTILE_COASTS)
def test_hostile_coasts_prove_nothing(document, what):
    path, value = HOSTILE_COASTS[what]
    assert not accepted(changed(document, path, value))


@pytest.mark.parametrize("what", HOSTILE)
def test_hostile_files_prove_nothing(document, what):
    path, value = HOSTILE[what]
    assert not accepted(changed(document, path, value))


@pytest.mark.parametrize("place", [("inertia", 0, 0), ("transfer", "window", "knots", 1)])
def test_thousands_of_digits_are_refused_before_multiplying(document, place):
    long = changed(document, ("data", *place), f"{4 * 10**1500 + 1}/{10**1500 + 9}")
    (finding,) = check_text(json.dumps(long))
    assert "too long" in finding.reason
    middling = changed(document, ("data", *place), f"{10**300 + 1}/{3 * 10**300 + 1}")
    assert "too long" not in check_text(json.dumps(middling))[0].reason


def test_a_field_given_twice_is_refused(document):
    text = json.dumps(document).replace('"claim": {', '"claim": {"peak": "1", ', 1)
    assert not all(f.valid for f in check_text(text))


def samples(count, seed):
    x = np.random.default_rng(seed).uniform(-1, 1, (count, 3))
    return [[Fraction(float(c)) for c in row] for row in x]


def cubic_value(p, x):
    return sum(c * x[0] ** e[0] * x[1] ** e[1] * x[2] ** e[2] for e, c in p.items())


def solid_value(p, x):
    units = range(len(p))
    every = [(i, j, k) for i in units for j in units for k in units if i + j + k < len(p)]
    return sum(
        Fraction(p[i][j][k], 2**checker.PEAK_BITS) * x[0] ** i * x[1] ** j * x[2] ** k for i, j, k in every
    )


def random_cubic(degree, seed):
    rng = np.random.default_rng(seed)
    span = range(degree + 1)
    every = [(i, j, k) for i in span for j in span for k in span if i + j + k <= degree]
    return {e: Fraction(round(float(rng.normal()), 6)) for e in every}


def test_rounding_of_cut_polynomials_is_counted():
    """Cutting seven times: the error at any point stays within the units counted for it."""
    degree, p = 6, {e: c / 3 for e, c in random_cubic(6, 1).items()}
    box, depth = checker.as_solid(p, degree), 0
    centre, half, order = [Fraction(0)] * 3, [Fraction(1)] * 3, [0, 1, 2]
    worst = Fraction(0)
    for side in (0, 1, 1, 0, 1, 0, 0):
        box, depth = checker.cut_solid(box)[side], depth + 1
        axis = order[2]
        half[axis] /= 2
        centre[axis] += half[axis] * (2 * side - 1)
        order = [order[2], order[0], order[1]]
        for t in samples(20, depth):
            local = [t[order.index(a)] for a in range(3)]
            true = cubic_value(p, [centre[a] + half[a] * local[a] for a in range(3)])
            worst = max(worst, abs(solid_value(box, t) - true) * 2**checker.PEAK_BITS / depth)
    assert worst <= checker.rounding_units(degree)
    assert worst > 1


def gauge_of(case):
    low, high = Fraction("0.3"), Fraction("0.48")
    J = [list(row) for row in case.body.exact_inertia]
    signs = (Fraction(1), Fraction(-1))
    cube = [[a, b, c] for a in signs for b in signs for c in signs]
    return checker.Gauge(J, cube, [[Fraction(1), Fraction(0)], [-low, Fraction(1)], [high, Fraction(-1)]])


def points_of(gauge, count, seed):
    """Momenta on the boundary of the set, floats."""
    H = np.random.default_rng(seed).standard_normal((count, 3))
    M = np.array([[[float(x) for x in row] for row in one] for one in gauge.rows])
    size = np.einsum("ni,kij,nj->nk", H, M, H) / np.array([float(x) for x in gauge.levels])
    return H / np.sqrt(size.max(axis=1))[:, None]


@pytest.mark.parametrize("boxed", [False, True])
def test_ellipsoids_hold_the_set(boxed):
    gauge = gauge_of(problem(LARGEST_COMPONENT))
    if boxed:
        gauge = gauge.with_box([Fraction(1), Fraction("1.1"), Fraction("1.2")])
    metrics, H = checker.Metrics(gauge), points_of(gauge, 4000, 1)
    for v in np.random.default_rng(2).standard_normal((60, 3)):
        F = metrics.about(list(v))[1]
        assert F is not None
        length = np.linalg.norm(np.array(F, dtype=float) @ v) * 2.0**-metrics.shift
        seen = (H @ v).max()
        assert seen <= length * (1 + 1e-12)
        assert length <= 1.05 * seen + 0.05


def test_bounds_over_boxes_are_above_samples():
    gauge = gauge_of(problem(LARGEST_COMPONENT)).with_box([Fraction(1)] * 3)
    metrics, H, unit = checker.Metrics(gauge), points_of(gauge, 300, 1), 2**checker.PEAK_BITS
    for seed in range(12):
        cubics = [
            {e: c / (1 + 4 * sum(e)) for e, c in random_cubic(3, 10 * seed + i).items()} for i in range(3)
        ]
        side = random_cubic(2, 99 + seed)
        solids = [checker.as_solid(p, 3) for p in cubics]
        error = checker.rounding_units(3)
        locals_ = [checker.local(p, error) for p in solids]
        region = checker.local(checker.as_solid(side, 2), checker.rounding_units(2))
        F = metrics.about([float(p[(0, 0, 0)]) for p in cubics])[1]
        square = checker.square_above(metrics.apply(F, locals_), region, 0)
        linear = checker.components_above(solids, [1 << 30] * 3, error)
        for x in samples(40, seed):
            v = np.array([float(cubic_value(p, x)) for p in cubics])
            assert np.abs(v).sum() <= float(Fraction(linear, unit << 30)) * (1 + 1e-12)
            if cubic_value(side, x) >= 0:
                assert (H @ v).max() <= math.sqrt(Fraction(square, unit**2)) * (1 + 1e-12)


def region_points(chart, count):
    x = np.random.default_rng(3).uniform(-1, 1, (count, 3))
    kept = np.ones(count, dtype=bool)
    for p in chart.region():
        kept &= sum(float(c) * x[:, 0] ** e[0] * x[:, 1] ** e[1] * x[:, 2] ** e[2] for e, c in p.items()) >= 0
    return x[kept]


def test_no_rate_below_one_that_occurs_is_proved(document):
    """The largest rate seen at points of the region, a millionth less: refused; the file's own: proved."""
    part = checker.Node(document["parts"][0], "part")
    witness = part["certificates"].items()[0]["witness"]
    d = checker.Transfer.read(part["data"])
    gauge = checker.Gauge(d.J, d.torques, [row.vector(2) for row in witness["rows"].items()])
    place = witness["separations"].items()[0]
    chart, phi = checker.PeakChart(place["chart"]), checker.read_potential(place["potential"])
    v = checker.rate_polynomials(phi, gauge.inverse, chart.outer)
    x = region_points(chart, 20_000)
    rates = np.stack(
        [
            sum(float(c) * x[:, 0] ** e[0] * x[:, 1] ** e[1] * x[:, 2] ** e[2] for e, c in p.items())
            for p in v
        ],
        axis=1,
    )
    seen = (rates @ points_of(gauge, 2000, 5).T).max()
    rate = place["rate"].number()
    assert seen <= rate
    assert checker.RateProof(gauge, rate).run(v, chart.region()) > 0
    with pytest.raises(checker.Invalid, match="not proved"):
        checker.RateProof(gauge, Fraction(float(seen) * (1 - 1e-6))).run(v, chart.region())
