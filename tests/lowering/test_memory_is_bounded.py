"""Samples go through in blocks: memory does not grow with their number."""

import tracemalloc
from fractions import Fraction

import numpy as np
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.laws import PersistenceFilter
from intermit.models.lowering import ArrayFunction, shared, walk
from intermit.models.rigid_body import RigidBody

BODY = body_values(RigidBody.from_rows([[3, 0, 0], [0, 4, 0], [0, 0, 5]]))


def evaluator(block=256):
    loop = close_loop(PersistenceFilter(Fraction(1, 2), Fraction(1)))
    program = shared(walk(loop.function("rates", loop.state_rate)))
    return loop, ArrayFunction(program, uniform=(2, 3), block=block)


def blocks(loop, count, size=1024):
    rng = np.random.default_rng(1)
    for _ in range(count):
        state = rng.normal(size=(loop.state.numel(), size))
        yield state, rng.normal(size=(2, size)), loop.parameter_values(), BODY


def peak(count):
    loop, arrays = evaluator()
    tracemalloc.start()
    seen = sum(r[0].shape[1] for r in arrays.stream(blocks(loop, count)))
    _, most = tracemalloc.get_traced_memory()
    tracemalloc.stop()
    assert seen == 1024 * count
    return most


def test_ten_times_the_samples_need_no_more_memory():
    few, many = peak(4), peak(40)
    assert many < few + 64 * 1024


def test_streamed_results_are_those_of_one_call():
    loop, arrays = evaluator()
    whole = [np.concatenate([b[i] for b in blocks(loop, 3)], axis=1) for i in range(2)]
    streamed = np.concatenate([r[0].copy() for r in arrays.stream(blocks(loop, 3))], axis=1)
    assert np.array_equal(streamed, arrays(*whole, loop.parameter_values(), BODY)[0])


def test_work_per_sample_is_counted():
    _, arrays = evaluator()
    assert arrays.sample_operations <= 180
    assert arrays.buffer_count <= 40
