"""What a transfer is asked to make least: the peak of its torque, or its impulse within a limit.

Both are convex in the control, so that both have the same kind of optimality gap (a dual value)
and the same kind of switching function; they differ in what a control is worth against it. All
numbers are in solver units; values are in the unit of a control.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

import numpy as np

from ....models.norms import Norm
from ....models.types import Array
from .optimality import dual_value, linearised_offset

if TYPE_CHECKING:
    from ..transcription.shooting import Rollout, Sensitivity, Shooting


class Goal(ABC):
    """A convex function of the control to be made least, and the limit on the control's effort."""

    @abstractmethod
    def value(self, shooting: Shooting, control: Array) -> float:
        """What is made least, homogeneous of degree one in the control (n, m)."""

    @abstractmethod
    def dual(
        self, shooting: Shooting, trajectory: Rollout, sensitivity: Sensitivity, multiplier: Array
    ) -> tuple[float, Array]:
        """Lower bound of the linearised problem from a multiplier of the residual, and the multiplier."""

    @abstractmethod
    def level(self, value: float) -> float:
        """Effort of a control that pushes as hard as it may, at an optimum of this value."""

    @abstractmethod
    def hamiltonian_gain(self, norm: Norm, costate: Array, flow: Array) -> Array:
        """The most that a control gains against a pull (..., m) when its impulse costs `flow` (...)."""

    @abstractmethod
    def gain(self, norm: Norm, costate: Array, flow: Array, control: Array, value: float) -> Array:
        """What a control (..., m) of this value gains against the pull, in the same measure."""

    @abstractmethod
    def unit(self, value: float) -> float:
        """What a `hamiltonian_gain` is divided by to be a fraction of the value."""

    @abstractmethod
    def switches(self, norm: Norm) -> tuple[int, ...]:
        """The control that each of j switches throws; -1 for the length of a ball's controls."""

    @abstractmethod
    def switch_fraction(self, norm: Norm, control: Array, value: float) -> Array:
        """How far each switch is thrown, 0 to 1, (..., m) -> (..., j)."""

    @abstractmethod
    def switching_function(self, norm: Norm, costate: Array) -> Array:
        """Rise of the pull, (..., m) -> (..., j): through a threshold where a switch is thrown."""

    @abstractmethod
    def turning(self, norm: Norm) -> tuple[slice, ...]:
        """Controls that have no switch, because their direction turns instead."""


@final
@dataclass(frozen=True)
class LeastPeak(Goal):
    """The least p with effort(v_k) <= p."""

    def value(self, shooting: Shooting, control: Array) -> float:
        """Largest effort."""
        return float(shooting.scaled.problem.norm.effort(control).max())

    def dual(
        self, shooting: Shooting, trajectory: Rollout, sensitivity: Sensitivity, multiplier: Array
    ) -> tuple[float, Array]:
        """Dual value, the multiplier normalised so that the whole pull is worth one."""
        return dual_value(shooting, trajectory, sensitivity, multiplier)

    def level(self, value: float) -> float:
        """The peak itself."""
        return value

    def hamiltonian_gain(self, norm: Norm, costate: Array, flow: Array) -> Array:
        """Support of the pull: what unit effort does."""
        del flow
        return norm.control_support(costate)

    def gain(self, norm: Norm, costate: Array, flow: Array, control: Array, value: float) -> Array:
        """Pull . control for each unit of the peak."""
        del norm, flow
        return np.asarray((costate * control).sum(axis=-1)) / value

    def unit(self, value: float) -> float:
        """One: the multiplier's normalisation makes it a fraction already."""
        del value
        return 1.0

    def switches(self, norm: Norm) -> tuple[int, ...]:
        """One for each control with limits of its own."""
        return tuple(j for block, at in norm.parts if not block.is_round for j in range(at.start, at.stop))

    def switch_fraction(self, norm: Norm, control: Array, value: float) -> Array:
        """From one limit to the other."""
        found = []
        for block, at in norm.parts:
            if not block.is_round:
                low = 0.0 if block.is_one_sided else -1.0
                found.append((control[..., at] / value - low) / (1.0 - low))
        return _side_by_side(found, control)

    def switching_function(self, norm: Norm, costate: Array) -> Array:
        """The pull on each control with limits of its own."""
        return _side_by_side([costate[..., at] for block, at in norm.parts if not block.is_round], costate)

    def turning(self, norm: Norm) -> tuple[slice, ...]:
        """Every ball."""
        return tuple(at for block, at in norm.parts if block.is_round)


@final
@dataclass(frozen=True)
class LeastImpulse(Goal):
    """The least integral of w consumption(v) with effort(v_k) <= limit, as a mean over the window time.

    Attributes
    ----------
    limit : float
        Solver units of control.
    """

    limit: float

    def value(self, shooting: Shooting, control: Array) -> float:
        """Mean consumption over the window time."""
        return float(shooting.weights @ shooting.scaled.problem.norm.consumption(control))

    def dual(
        self, shooting: Shooting, trajectory: Rollout, sensitivity: Sensitivity, multiplier: Array
    ) -> tuple[float, Array]:
        """Minimum of the Lagrangian over all controls within the limit."""
        norm = shooting.scaled.problem.norm
        costate = -np.einsum("i,ikm->km", multiplier, sensitivity.terminal)
        offset = linearised_offset(shooting, trajectory, sensitivity, multiplier)
        return offset - float(self.hamiltonian_gain(norm, costate, shooting.weights).sum()), multiplier

    def level(self, value: float) -> float:
        """The limit."""
        del value
        return self.limit

    def hamiltonian_gain(self, norm: Norm, costate: Array, flow: Array) -> Array:
        """Limit times what the pull exceeds the cost of the impulse by."""
        over = self.switching_function(norm, costate) - flow[..., None]
        return np.asarray(self.limit * np.maximum(over, 0.0).sum(axis=-1))

    def gain(self, norm: Norm, costate: Array, flow: Array, control: Array, value: float) -> Array:
        """Pull . control less the cost of its impulse."""
        del value
        return np.asarray((costate * control).sum(axis=-1) - flow * norm.consumption(control))

    def unit(self, value: float) -> float:
        """The value."""
        return max(value, 1e-300)

    def switches(self, norm: Norm) -> tuple[int, ...]:
        """One for each ball and each other control."""
        found = [[-1] if block.is_round else list(range(at.start, at.stop)) for block, at in norm.parts]
        return tuple(j for part in found for j in part)

    def switch_fraction(self, norm: Norm, control: Array, value: float) -> Array:
        """From off to the limit."""
        del value
        return self.switching_function(norm, control) / self.limit

    def switching_function(self, norm: Norm, costate: Array) -> Array:
        """Length of a ball's controls, size of each other, or each one-sided control itself."""
        found = []
        for block, at in norm.parts:
            part = costate[..., at]
            if block.is_round:
                found.append(np.linalg.norm(part, axis=-1)[..., None])
            else:
                found.append(part if block.is_one_sided else np.abs(part))
        return _side_by_side(found, costate)

    def turning(self, norm: Norm) -> tuple[slice, ...]:
        """None: what turns is off or full as well."""
        del norm
        return ()


def _side_by_side(parts: list[Array], like: Array) -> Array:
    """Join (..., j) arrays of the blocks; without any, none of `like`'s columns."""
    return np.concatenate([like[..., :0], *parts], axis=-1)
