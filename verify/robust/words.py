"""An uncertainty in words."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction

from ...models.uncertainty import Uncertainty


def covered_words(uncertainty: Uncertainty) -> str:
    """Return every body, thruster and disturbance of an uncertainty, for a claim's sentence."""
    return "every " + ", ".join(_parts(uncertainty)) if uncertainty.channels else "a body known exactly"


def _parts(u: Uncertainty) -> Iterator[str]:
    inertia = []
    if u.inertia_tolerance is not None:
        flat = {x for row in u.inertia_tolerance for x in row}
        size = f"{float(flat.pop()):g} kg m^2" if len(flat) == 1 else "its tolerance"
        inertia.append(f"each entry of J - J0 within {size}")
    if u.inertia_relative:
        rho = f"{float(u.inertia_relative):g}"
        inertia.append(f"(1 - {rho}) J0 <= J <= (1 + {rho}) J0")
    if any(u.inertia_scale):
        inertia.append(f"scaled by {_factors(u.inertia_scale)}")
    if inertia:
        yield f"inertia with {' and '.join(inertia)}"
    if any(u.thrust_error):
        how = "for all time" if u.thrust_error_varies == "never" else "constant within each firing"
        yield f"thrust factor {_factors(u.thrust_error)} {how}"
    if u.misalignment_deg:
        yield f"fixed misalignment up to {float(u.misalignment_deg):g} deg"
    if u.disturbance:
        yield f"disturbance torque up to {float(u.disturbance):g} N m, varying at will"


def _factors(interval: tuple[Fraction, Fraction]) -> str:
    return f"{float(1 + interval[0]):g} to {float(1 + interval[1]):g}"
