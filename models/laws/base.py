"""What a control law is to the rest of the package.

A law is written once, as CasADi expressions: its controller states and their rates, and the
designated torque u; the thrusters apply g(t) u. Everything else (simulation, sampling, proofs,
comparison) works on these expressions and knows no law by name.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field, fields, is_dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, ClassVar, final

from .equations import Equation
from .parameters import Parameter, parameters_of

if TYPE_CHECKING:
    from ..schedule import Schedule
    from ..time_signals import TimeSignal

Expression = Any
"""A CasADi SX expression (CasADi ships no types)."""


@final
@dataclass(frozen=True, eq=False)
class PlantSymbols:
    """The plant as a law sees it.

    Attributes
    ----------
    b0, bv : quaternion, scalar and vector part, () and (3,)
    w : body rate, rad/s, (3,)
    J : inertia, kg m^2, (3, 3)
    b0_rate, bv_rate : quaternion kinematics, 1/s
    """

    b0: Expression
    bv: Expression
    w: Expression
    J: Expression
    b0_rate: Expression
    bv_rate: Expression


@final
@dataclass(frozen=True, eq=False)
class TimeSymbols:
    """Known functions of time: the gain g, its rate (1/s), and the law's own signals with their rates."""

    g: Expression
    g_rate: Expression
    signals: Mapping[str, Expression] = field(default_factory=dict)
    signal_rates: Mapping[str, Expression] = field(default_factory=dict)


@final
@dataclass(frozen=True)
class ControllerState:
    """One controller state: its name, exact initial value and unit.

    Attributes
    ----------
    least : what the law keeps the state above, where it does; states are drawn from there on when V' is
        sampled, and no proof rests on it
    """

    name: str
    initial: Fraction
    unit: str = ""
    least: Fraction | None = None

    def __post_init__(self) -> None:
        try:
            object.__setattr__(self, "initial", Fraction(self.initial))
        except (TypeError, ValueError, OverflowError):
            raise ValueError(
                f"controller state {self.name}: expected a finite number to start from, "
                f"received {self.initial!r}"
            ) from None


@final
@dataclass(frozen=True, eq=False)
class Control:
    """What a law returns.

    Attributes
    ----------
    torque : designated torque u, N m, (3,); the thrusters apply g u
    state_rates : rate of every controller state, by name
    gain, gain_rate : kappa (1/s) and its rate where the law has the form
        Omega = w + 2 g^2 kappa bv; None for other laws
    thrust : (3, 3), what the thrusters make of g u; None is the unit matrix
    disturbance : torque that acts beside it, window or not, N m, (3,); None is none. A law that states
        either is simulated as it says, and loses every proof about g u.
    """

    torque: Expression
    state_rates: Mapping[str, Expression] = field(default_factory=dict)
    gain: Expression | None = None
    gain_rate: Expression | None = None
    thrust: Expression | None = None
    disturbance: Expression | None = None


class Law(ABC):
    """A feedback law. Subclass it as a frozen dataclass whose fields are exact parameters.

    Every field that holds a number becomes a CasADi symbol of the same name (a trailing
    underscore is dropped: `lambda_` is the parameter lambda). Its unit and bound stand beside it:
    `lambda_: Fraction = field(metadata=known("1/s", "> 0", "filter bandwidth"))`.

    Attributes
    ----------
    name : what messages, certificates and scenario files call it; it proves nothing
    equations : what reports set of it; none by default
    """

    name: ClassVar[str]
    equations: ClassVar[tuple[Equation, ...]] = ()

    @abstractmethod
    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Return the designated torque and the rates of the controller states."""

    @property
    def parameters(self) -> dict[str, Fraction]:
        """Exact parameter values by name, in field order."""
        law: Any = self
        if not is_dataclass(law):
            raise TypeError(f"law {type(law).__name__} must be a dataclass: its fields are its parameters")
        values = {f.name.rstrip("_"): getattr(law, f.name) for f in fields(law)}
        return {key: Fraction(v) for key, v in values.items() if isinstance(v, (int, float, Fraction))}

    @classmethod
    def described(cls) -> dict[str, Parameter]:
        """What is known of each parameter, by name: unit, bound, default, meaning."""
        return parameters_of(cls)

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """Controller states with their initial values; none by default."""
        return ()

    @property
    def signals(self) -> tuple[TimeSignal, ...]:
        """Functions of time computed from the schedule ahead of time; none by default."""
        return ()

    def reset_instants(self, schedule: Schedule, start: Fraction, stop: Fraction) -> tuple[Fraction, ...]:
        """Instants in [start, stop) at which the law decides anew (see `reset`); none by default."""
        del schedule, start, stop
        return ()

    def reset(
        self, plant: PlantSymbols, states: Mapping[str, Expression], parameters: Mapping[str, Expression]
    ) -> Mapping[str, Expression]:
        """New values of the controller states that change at a reset instant; none by default."""
        del plant, states, parameters
        return {}

    def proofs(self) -> tuple[object, ...]:
        """Return ways in which the law can be proved, of its own; none by default.

        Each is an `intermit.verify.filter.proofs.ComparisonProof`. What it says is checked against the law's
        equations, and its certificates by the stand-alone checker (docs/how-to/add-a-law.md).
        """
        return ()

    def storage(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Expression | None:
        """Return the law's own storage function as an expression, or None if it has none to offer.

        It must not use `time.g_rate`: its derivative along the closed loop is formed by the
        chain rule in (state, g, signals).
        """
        del plant, time, states, parameters
        return None
