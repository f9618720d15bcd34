"""Scrambled Sobol points as rows, block by block: a fixed table xor a few bits a block.

In Gray-code order the points of block b are those of the first block, xor one number a coordinate:
gray(b 2^m + i) = gray(b 2^m) xor gray(i). So a block costs one xor and one product a coordinate.
The points are scipy's `qmc.Sobol(..., scramble=True)` to the last bit, without loading
`scipy.stats`, which takes longer than a million samples.

Source: Joe & Kuo, SIAM J. Sci. Comput. 30 (2008), direction numbers new-joe-kuo-6.21201; Matousek,
J. Complexity 14 (1998), linear matrix scrambling with a digital shift.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import final

import numpy as np
from numpy.typing import NDArray

from ...models.types import Array

Bits = NDArray[np.uint32]

BITS = 30
"""Binary digits of a coordinate: 2^30 points are distinct."""
MANTISSA = np.uint64(52 - BITS)
ONE = np.float64(1.0).view(np.uint64)

PRIMITIVE: tuple[tuple[int, tuple[int, ...]], ...] = (
    (1, (1,)), (3, (1,)), (7, (1, 3)), (11, (1, 3, 1)), (13, (1, 1, 1)), (19, (1, 1, 3, 3)),
    (25, (1, 3, 5, 13)), (37, (1, 1, 5, 5, 17)), (41, (1, 1, 5, 5, 5)), (47, (1, 1, 7, 11, 19)),
    (55, (1, 1, 5, 1, 1)), (59, (1, 1, 1, 3, 11)), (61, (1, 3, 5, 5, 31)), (67, (1, 3, 3, 9, 7, 49)),
    (91, (1, 1, 1, 15, 21, 21)), (97, (1, 3, 1, 13, 27, 49)), (103, (1, 1, 1, 15, 7, 5)),
    (109, (1, 3, 1, 15, 13, 25)), (115, (1, 1, 5, 5, 19, 61)), (131, (1, 3, 7, 11, 23, 15, 103)),
    (137, (1, 3, 7, 13, 13, 15, 69)), (143, (1, 1, 3, 13, 7, 35, 63)), (145, (1, 3, 5, 9, 1, 25, 53)),
    (157, (1, 3, 1, 13, 9, 35, 107)), (167, (1, 3, 1, 5, 27, 61, 31)), (171, (1, 1, 5, 11, 19, 41, 61)),
    (185, (1, 3, 5, 3, 3, 13, 69)), (191, (1, 1, 7, 13, 1, 19, 1)), (193, (1, 3, 7, 5, 13, 19, 59)),
    (203, (1, 1, 3, 9, 25, 29, 41)), (211, (1, 3, 5, 13, 23, 1, 55)), (213, (1, 3, 7, 3, 13, 59, 17)),
)  # fmt: skip
"""Primitive polynomial of each coordinate, as bits, and its first direction numbers."""


@final
class SobolRows:
    """Points of a scrambled Sobol sequence in the unit cube.

    Parameters
    ----------
    dimension : int
        Coordinates, at most 32.
    seed : int
        Of the scrambling.
    block : int
        Points a block, a power of 2 up to 2^30.
    """

    def __init__(self, dimension: int, *, seed: int, block: int) -> None:
        if not 1 <= dimension <= len(PRIMITIVE):
            raise ValueError(f"expected 1 to {len(PRIMITIVE)} coordinates, received {dimension}")
        if block < 1 or block & (block - 1) or block > 1 << BITS:
            raise ValueError(f"block must be a power of 2 up to 2^{BITS}, received {block}")
        self.dimension, self.block = dimension, block
        self._directions, shift = _scrambled(dimension, np.random.default_rng(seed).spawn(1)[0])
        first = _gray_table(self._directions, block) ^ shift[:, None]
        # As the mantissa of a number in [1, 2): from there one difference, exact, gives the coordinate.
        self._first = first.astype(np.uint64) << MANTISSA | ONE

    def blocks(self) -> Iterator[Array]:
        """Rows of coordinates, (dimension, block), block after block; each overwrites the one before."""
        moved = np.empty_like(self._first)
        points = np.empty(moved.shape)
        for number in range((1 << BITS) // self.block):
            start = number * self.block
            np.bitwise_xor(self._first, self._offset(start ^ (start >> 1))[:, None], out=moved)
            np.subtract(moved.view(np.float64), 1.0, out=points)
            yield points

    def _offset(self, gray: int) -> NDArray[np.uint64]:
        chosen = [j for j in range(BITS) if gray >> j & 1]
        offset: Bits = np.bitwise_xor.reduce(self._directions[:, chosen], axis=1)
        return np.left_shift(offset.astype(np.uint64), MANTISSA)


def _directions(dimension: int) -> Bits:
    """Direction numbers (dimension, BITS), as BITS-digit binary fractions."""
    rows = [[1] * BITS]
    for polynomial, first in PRIMITIVE[1:dimension]:
        degree, row = polynomial.bit_length() - 1, list(first)
        for j in range(degree, BITS):
            value = row[j - degree]
            for k in range(degree):
                if polynomial >> (degree - 1 - k) & 1:
                    value ^= row[j - k - 1] << (k + 1)
            row.append(value)
        rows.append(row)
    return np.array([[v << (BITS - 1 - j) for j, v in enumerate(row)] for row in rows], dtype=np.uint32)


def _scrambled(dimension: int, rng: np.random.Generator) -> tuple[Bits, Bits]:
    """Directions times random unit lower triangular matrices over {0, 1}, and a random shift."""
    powers = 2 ** np.arange(BITS, dtype=np.uint32)
    shift = np.dot(rng.integers(2, size=(dimension, BITS), dtype=np.uint32), powers)
    lower = np.tril(rng.integers(2, size=(dimension, BITS, BITS), dtype=np.uint32))
    lower[:, range(BITS), range(BITS)] = 1
    leading = powers[::-1]
    digits = (_directions(dimension)[:, None, :] & leading[:, None]) != 0  # (d, digit, direction)
    mixed = (lower @ digits.astype(np.uint32)) & 1
    return np.einsum("dpj,p->dj", mixed, leading).astype(np.uint32), shift.astype(np.uint32)


def _gray_table(directions: Bits, count: int) -> Bits:
    """The first `count` points of each coordinate in Gray-code order, unshifted."""
    table = np.zeros((len(directions), count), dtype=np.uint32)
    half = 1
    while half < count:
        j = half.bit_length() - 1
        step = directions[:, j] ^ (directions[:, j - 1] if j else 0)
        table[:, half : 2 * half] = table[:, :half] ^ step[:, None]
        half *= 2
    return table
