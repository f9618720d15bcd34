"""The inertia of the data and its box of tolerances."""

from __future__ import annotations

from .exact_numbers import Matrix, require
from .matrices import is_positive_definite, is_symmetric, show_matrix
from .reading import Node


def read_inertia(data: Node) -> Matrix:
    """Return the inertia matrix of the data, kg m^2, checked to be symmetric and positive definite."""
    J = data["inertia"].matrix(3, 3)
    require(is_positive_definite(J), "the inertia is not symmetric and positive definite")
    return J


def inertia_vertices(data: Node) -> list[Matrix]:
    """Return the inertias at the vertices of the box of tolerances, or the one given, checked definite."""
    J = read_inertia(data)
    if not data.has("inertia_tolerance"):
        return [J]
    radius = data["inertia_tolerance"].matrix(3, 3)
    require(
        is_symmetric(radius) and all(x >= 0 for row in radius for x in row),
        "tolerances must be >= 0, symmetric",
    )
    places = [(i, j) for i in range(3) for j in range(i, 3) if radius[i][j] > 0]
    vertices = []
    for number in range(2 ** len(places)):
        vertex = [list(row) for row in J]
        for bit, (i, j) in enumerate(places):
            vertex[i][j] = J[i][j] + (radius[i][j] if number >> bit & 1 else -radius[i][j])
            vertex[j][i] = vertex[i][j]
        require(is_positive_definite(vertex), "an inertia within the tolerance is not positive definite")
        vertices.append(vertex)
    return vertices


def describe_inertia(data: Node) -> str:
    """Return the inertia for people."""
    text = f"inertia J = {show_matrix(data['inertia'].matrix())} kg m^2"
    if data.has("inertia_tolerance"):
        text += f" +- {show_matrix(data['inertia_tolerance'].matrix())}"
    return text
