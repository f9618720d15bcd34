"""Corners of what thrusters can do are among all choices of them, and none that counts is missing."""

from fractions import Fraction as F
from itertools import product

import numpy as np
import pytest
from intermit.models.norm_blocks import Box
from intermit.models.norms import BODY_AXES, LARGEST_COMPONENT, Norm, thrusters
from intermit.models.zonotope import zonotope_vertices


def all_choices(axes):
    """Sums over every subset, by hand."""
    return {
        tuple(sum((a[i] for a, on in zip(axes, choice, strict=True) if on), F(0)) for i in range(3))
        for choice in product((0, 1), repeat=len(axes))
    }


def random_axes(seed):
    """Generators with parallel, opposite, coplanar and zero ones among them."""
    rng = np.random.default_rng(seed)
    axes = [tuple(F(int(x), 3) for x in rng.integers(-3, 4, 3)) for _ in range(int(rng.integers(1, 7)))]
    kind = seed % 4
    axes += [tuple(-2 * x for x in axes[0])] if kind == 1 else []
    axes += [axes[0]] if kind == 2 else []
    return [(x, y, F(0)) for x, y, _ in axes] if kind == 3 else axes


@pytest.mark.parametrize("seed", range(40))
def test_they_are_choices_and_reach_as_far_in_every_direction(seed):
    axes = random_axes(seed)
    found, choices = zonotope_vertices(axes), all_choices(axes)
    assert set(found) <= choices
    directions = np.random.default_rng(seed).integers(-9, 10, (60, 3)).tolist()
    for d in [*directions, [1, 0, 0], [0, 0, 1], [0, 0, -1]]:
        reach = [max(sum(F(x) * y for x, y in zip(d, p, strict=True)) for p in of) for of in (found, choices)]
        assert reach[0] == reach[1]


def test_leaving_one_out_is_seen():
    """Partner: every corner of a box counts."""
    corners = zonotope_vertices([(F(1), F(0), F(0)), (F(0), F(2), F(0)), (F(0), F(0), F(3))])
    assert len(corners) == len(set(corners)) == 8
    for left_out in corners:
        rest = [p for p in corners if p != left_out]
        outward = [1 if x else -1 for x in left_out]
        reach = [
            max(sum(a * b for a, b in zip(outward, p, strict=True)) for p in of) for of in (corners, rest)
        ]
        assert reach[0] > reach[1]


def test_many_thrusters_have_few_corners():
    rng = np.random.default_rng(3)
    axes = [tuple(F(int(x)) for x in rng.integers(-50, 51, 3)) for _ in range(24)]
    assert len(thrusters(axes).corners()) <= 24 * 23 + 2  # of 2^24 choices


def test_both_ways_is_a_pair_of_thrusters():
    pairs = thrusters([[s * x for x in axis] for axis in BODY_AXES for s in (1, -1)])
    assert set(LARGEST_COMPONENT.corners()) == set(pairs.corners()) == set(product((F(-1), F(1)), repeat=3))
    mixed = Norm("mixed", "mixed", (Box(2), Box(1, low=0)))
    assert set(mixed.corners()) == set(product((F(-1), F(1)), (F(-1), F(1)), (F(0), F(1))))
