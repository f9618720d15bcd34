"""The sampled derivative: scipy's points without scipy.stats, and memory that does not grow with them."""

import tracemalloc
from fractions import Fraction
from itertools import islice

import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScaling
from intermit.models.rigid_body import RigidBody
from intermit.verify.sampling import SampledDomain, Sampling, derivative_function, sample_derivative
from intermit.verify.sampling.sampling import KEPT, _Least
from intermit.verify.sampling.sobol import PRIMITIVE, SobolRows
from scipy.stats import qmc

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
LAW = AdaptiveScaling(Fraction("0.525"), Fraction("0.1"), Fraction(1), Fraction("0.2"))
DOMAIN = SampledDomain(
    rate=Fraction(1), controller=((Fraction("0.15"), Fraction(2)), (Fraction(0), Fraction(6))),
    names=("R", "k"), gain=Fraction(1), gain_rate=Fraction(2),
)  # fmt: skip


@pytest.mark.parametrize(("dimension", "seed", "block"), [(10, 1, 256), (32, 7, 64), (1, 3, 1), (3, 2, 2)])
def test_points_are_those_of_scipy_to_the_last_bit(dimension, seed, block):
    engine = qmc.Sobol(dimension, scramble=True, rng=np.random.default_rng(seed))
    other = SobolRows(dimension, seed=seed + 1, block=block).blocks()
    for rows in islice(SobolRows(dimension, seed=seed, block=block).blocks(), 9):
        assert np.array_equal(rows.T, engine.random(block))
        assert not np.array_equal(rows, next(other))


def test_what_the_sequence_does_not_have_is_refused():
    with pytest.raises(ValueError, match="1 to 32 coordinates, received 33"):
        SobolRows(len(PRIMITIVE) + 1, seed=1, block=8)
    with pytest.raises(ValueError, match="power of 2"):
        SobolRows(3, seed=1, block=12)
    with pytest.raises(ValueError, match=r"2\^30 distinct points"):
        Sampling(count=2**30 + 1)


def test_states_are_unit_quaternions_in_the_stated_box():
    cube = np.random.default_rng(2).random((DOMAIN.dimension, 4096))
    cube[1, :3], cube[2, :3] = 0.5, [0.0, 0.5, np.nextafter(1, 0)]
    states = DOMAIN.states(cube.T)
    np.testing.assert_allclose(np.sum(states[:4] ** 2, axis=0), 1, atol=1e-15)
    angles = 2 * np.pi * cube[1:3]
    expected = [
        np.sqrt(cube[0]) * np.cos(angles[1]), np.sqrt(1 - cube[0]) * np.sin(angles[0]),
        np.sqrt(1 - cube[0]) * np.cos(angles[0]), np.sqrt(cube[0]) * np.sin(angles[1]),
    ]  # fmt: skip
    np.testing.assert_allclose(states[:4], expected, atol=5e-16)
    low, high = DOMAIN.bounds()
    assert np.all(states[4:] >= low[:, None])
    assert np.all(states[4:] <= high[:, None])


def test_the_least_of_all_blocks_are_kept_whatever_the_blocks():
    values = np.random.default_rng(3).normal(size=1000)
    values[[5, 500]] = np.inf
    kept = _Least()
    for part in np.split(np.arange(1000), [3, 8, 500, 700]):
        kept.add(values[part], part[None].astype(float))
    order = np.argsort(values)[:KEPT]
    assert np.array_equal(kept.values, values[order])
    assert np.array_equal(kept.points[:, 0], order)


def peak(count):
    check = derivative_function(close_loop(LAW))
    tracemalloc.start()
    found = sample_derivative(check, J1, DOMAIN, gain_target=Fraction(7), sampling=Sampling(count=count))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert found.counts.sum() == count
    return most


def test_sixteen_times_the_samples_need_no_more_memory():
    peak(1 << 10)  # what is imported and cached once
    few, many = peak(1 << 15), peak(1 << 19)
    assert many < few + 64 * 1024
    assert many < 16e6
