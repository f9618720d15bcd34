"""The gauge of momenta of a transfer."""

from __future__ import annotations

from fractions import Fraction

from .exact_numbers import Matrix, Vector, require
from .matrices import inverse_matrix, is_positive_semidefinite
from .peak_numbers import axis_matrix, combination, quadratic, root_interval


class Gauge:
    """K = {H'M_k H <= L_k}: a set of momenta, and the gauge N that grows by at most p w."""

    def __init__(self, J: Matrix, torques: list[Vector] | None, rows: list[Vector]) -> None:
        self.J, self.inverse = J, inverse_matrix(J)
        unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
        self.rows = [combination(pair, [unit, self.inverse]) for pair in rows]
        require(bool(rows), "the set of momenta has no rows")
        for M in self.rows:
            require(is_positive_semidefinite(M), "a row of the set of momenta is not positive semidefinite")
        if torques is None:
            require(all(b == 0 for _, b in rows), "the unit ball of torques has rows with b = 0 only")
            self.levels = [a for a, _ in rows]
        else:
            self.levels = [max(quadratic(M, t) for t in torques) for M in self.rows]
        require(all(level > 0 for level in self.levels), "a row of the set of momenta bounds no torque")
        self.box: Vector | None = None

    def with_box(self, box: Vector) -> Gauge:
        """Return the part with |H_i| <= box[i]; all of that box if the set is a ball."""
        require(all(b > 0 for b in box), "the half widths of a box must be positive")
        corner = sum((b * b for b in box), Fraction(0)) if len(self.rows) == 1 else Fraction(0)
        part = Gauge.__new__(Gauge)
        part.J, part.inverse, part.box = self.J, self.inverse, box
        part.rows = self.rows + [axis_matrix(i) for i in range(3)]
        part.levels = [max(self.levels[0], corner), *self.levels[1:]] + [b * b for b in box]
        return part

    def size(self, H: Vector) -> tuple[Fraction, Fraction]:
        """Enclose the gauge of a momentum."""
        if not any(H):
            return Fraction(0), Fraction(0)
        pairs = [root_interval(quadratic(M, H) / L) for M, L in zip(self.rows, self.levels, strict=True)]
        return max(low for low, _ in pairs), max(high for _, high in pairs)

    def require_rates_within(self, rate: Fraction, size: Fraction) -> None:
        """Prove that the gauge of J w is at most `size` for every |w| <= rate."""
        require(rate >= 0 and size >= 0, "rates and sizes must not be negative")
        unit = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])
        columns = [list(column) for column in zip(*self.J, strict=True)]
        for M, L in zip(self.rows, self.levels, strict=True):
            moved = [
                [sum((x * y for x, y in zip(row, c, strict=True)), Fraction(0)) for c in columns] for row in M
            ]
            form = [
                [sum((self.J[i][k] * moved[k][j] for k in range(3)), Fraction(0)) for j in range(3)]
                for i in range(3)
            ]
            gap = combination([size**2 * L, -(rate**2)], [unit, form])
            require(is_positive_semidefinite(gap), "the size of the terminal rate is not proved")

    def largest(self, G: Matrix, weights: Vector) -> Fraction:
        """Upper bound of H'G H over K, by multipliers of the rows."""
        require(all(l >= 0 for l in weights), "multipliers must not be negative")
        gap = combination([*weights, Fraction(-1)], [*self.rows, G])
        require(is_positive_semidefinite(gap), "multipliers do not dominate their form")
        return sum((l * L for l, L in zip(weights, self.levels, strict=True)), Fraction(0))

    def speed(self, weights: Vector) -> Fraction:
        """Upper bound of |J^-1 H| over K."""
        A = self.inverse
        square = [
            [sum((A[i][k] * A[k][j] for k in range(3)), Fraction(0)) for j in range(3)] for i in range(3)
        ]
        return root_interval(self.largest(square, weights))[1]
