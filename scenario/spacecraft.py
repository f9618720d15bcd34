"""From the [spacecraft] table to a rigid body and its inertia tolerance."""

from __future__ import annotations

from fractions import Fraction
from itertools import product
from typing import Any

import numpy as np

from ..models.apart import apart
from ..models.rigid_body import ExactMatrix, RigidBody, leading_minors
from .document import Document
from .errors import ScenarioError
from .schema import SpacecraftTable

MAX_RATIO = 1e6
"""Greatest over least principal inertia: a run's quickest motion is so much quicker than its slowest."""


def build(
    table: SpacecraftTable, document: Document
) -> tuple[RigidBody, ExactMatrix | None, tuple[str, ...]]:
    """Body, largest deviation of each entry of its inertia (or None), and warnings.

    Raises
    ------
    ScenarioError
        If the inertia is not symmetric or not positive definite, or the tolerance is not a number
        or a symmetric 3 by 3 table of numbers >= 0, or reaches an inertia that is none.
    """
    name, matrix = _inertia(table, document)
    key = document.where(name)
    try:
        body = RigidBody(matrix)
    except ValueError as error:
        raise ScenarioError(key, str(error)) from None
    least, _, greatest = np.sort(body.principal_inertias)
    if greatest > MAX_RATIO * least:
        raise ScenarioError(
            key,
            f"principal inertias from {least:.6g} to {greatest:.6g} kg m^2: their ratio is "
            f"{apart(greatest / least, MAX_RATIO)[0]}, and beyond {MAX_RATIO:g} no motion can be followed in "
            "double precision",
        )
    warnings: tuple[str, ...] = ()
    if not body.satisfies_triangle_inequality:
        a, b, c = np.sort(body.principal_inertias)
        warnings = (
            f"{key}: breaks the triangle inequality (principal inertias {a:.6g}, {b:.6g}, {c:.6g} kg m^2): "
            "no rigid body has it; the results stand for the equations as given",
        )
    tolerance = known_to(table.inertia_tolerance, body, document.where("spacecraft.inertia_tolerance"))
    return body, tolerance, warnings


def known_to(value: Any, body: RigidBody, where: str) -> ExactMatrix | None:
    """Return an inertia's tolerance entry by entry, from a number or rows; None where there is none.

    Raises
    ------
    ScenarioError
        If it is no symmetric tolerance, or reaches an inertia that is not positive definite.
    """
    if value is None:
        return None
    tolerance = _tolerance(value, where)
    if not _stays_definite(body.exact_inertia, tolerance):
        raise ScenarioError(where, "reaches an inertia that is not positive definite: make it smaller")
    return tolerance


def _inertia(table: SpacecraftTable, document: Document) -> tuple[str, ExactMatrix]:
    """The matrix J, and the key that gives it."""
    moments, products = table.inertia_moments, table.inertia_products
    if table.inertia is not None:
        if moments is not None or products is not None:
            other = "inertia_moments" if moments is not None else "inertia_products"
            raise ScenarioError(
                document.where(f"spacecraft.{other}"),
                "the inertia is given twice: give inertia (the matrix J, J12 = -integral of x y), or "
                "inertia_moments with inertia_products (the integrals themselves)",
            )
        return "spacecraft.inertia", table.inertia
    if moments is None:
        raise ScenarioError(
            document.where("spacecraft.inertia"),
            "required, but missing (or give inertia_moments with inertia_products)",
        )
    if products is None:
        raise ScenarioError(
            document.where("spacecraft.inertia_products"),
            "required beside inertia_moments, but missing: { xy = 0, xz = 0, yz = 0 } for principal axes",
        )
    xx, yy, zz = moments
    xy, xz, yz = -products.xy, -products.xz, -products.yz
    return "spacecraft.inertia_moments", ((xx, xy, xz), (xy, yy, yz), (xz, yz, zz))


def _stays_definite(inertia: ExactMatrix, tolerance: ExactMatrix) -> bool:
    """Whether every inertia of the box is positive definite: decided at its vertices, since J is affine."""
    places = [(i, j) for i in range(3) for j in range(i, 3) if tolerance[i][j] > 0]
    for signs in product((-1, 1), repeat=len(places)):
        vertex = [list(row) for row in inertia]
        for (i, j), sign in zip(places, signs, strict=True):
            vertex[i][j] = vertex[j][i] = inertia[i][j] + sign * tolerance[i][j]
        if not all(minor > 0 for minor in leading_minors(vertex)):
            return False
    return True


def _tolerance(value: Any, key: str) -> ExactMatrix:
    rows = value if isinstance(value, list) else [[value] * 3] * 3
    shaped = len(rows) == 3 and all(isinstance(row, list) and len(row) == 3 for row in rows)
    if not shaped or not all(isinstance(x, Fraction) for row in rows for x in row):
        raise ScenarioError(key, "expected a number or three rows of three numbers")
    numbers: list[list[Fraction]] = rows
    for i in range(3):
        for j in range(3):
            if numbers[i][j] < 0:
                raise ScenarioError(key, f"must be >= 0, received {float(numbers[i][j]):g}")
            if numbers[i][j] != numbers[j][i]:
                raise ScenarioError(key, "must be symmetric")
    first, second, third = ((row[0], row[1], row[2]) for row in numbers)
    return first, second, third
