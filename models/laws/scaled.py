"""The family of laws with one gain kappa: Omega = w + 2 g^2 kappa bv.

Source: Ram & Akella, AAS 21-402 (control input and augmented state); kappa = 1/R is the
persistence-filter law of the earlier literature, kappa = k the adaptive scaling.
"""

from __future__ import annotations

from .base import Expression, PlantSymbols, TimeSymbols
from .equations import Equation

FILTER = Equation(
    "Persistence filter state",
    r"dot(R) = -lambda R + g^2 (1 + beta_0), quad R(0) > 0",
    r"\dot R=-\lambda R+g^2(1+\beta_0),\qquad R(0)>0",
)
TORQUE = Equation(
    "Commanded torque",
    r"vb(Omega) &= vb(omega) + 2 g^2 kappa thin vb(beta)_v, \ "
    r"vb(u) &= -2 g kappa thin vb(beta)_v times vb(J) vb(omega) - 4 dot(g) kappa thin vb(J) vb(beta)_v "
    r"- 2 g dot(kappa) thin vb(J) vb(beta)_v \ "
    r"&quad - 2 g kappa thin vb(J) dot(vb(beta))_v - 1/2 g kappa (1 + beta_0) vb(J) vb(Omega)",
    r"\begin{aligned}\bm\Omega&=\bm\omega+2g^2\kappa\bm\beta_v,\\"
    r"\bm u&=-2g\kappa\,\bm\beta_v\times\bm J\bm\omega-4\dot g\kappa\bm J\bm\beta_v"
    r"-2g\dot\kappa\bm J\bm\beta_v\\"
    r"&\quad-2g\kappa\bm J\dot{\bm\beta}_v-\tfrac12g\kappa(1+\beta_0)\bm J\bm\Omega\end{aligned}",
)


def filter_rate(plant: PlantSymbols, time: TimeSymbols, R: Expression, lam: Expression) -> Expression:
    """Persistence filter R' = -lambda R + g^2 (1 + b0)."""
    return -lam * R + time.g**2 * (1 + plant.b0)


def augmented_rate(plant: PlantSymbols, time: TimeSymbols, kappa: Expression) -> Expression:
    """Omega = w + 2 g^2 kappa bv, rad/s."""
    return plant.w + 2 * time.g**2 * kappa * plant.bv


def scaled_torque(
    plant: PlantSymbols,
    time: TimeSymbols,
    kappa: Expression,
    kappa_rate: Expression,
    *,
    gain_rate_weight: Expression | None = None,
) -> Expression:
    """Designated torque u of the family, N m.

    With it J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega holds exactly.
    `gain_rate_weight` replaces J in the term with kappa': the printed persistence-filter law
    leaves J out there.
    """
    import casadi as ca

    g, J, bv = time.g, plant.J, plant.bv
    weight = J if gain_rate_weight is None else gain_rate_weight
    Omega = augmented_rate(plant, time, kappa)
    return (
        -2 * g * kappa * ca.cross(bv, J @ plant.w)
        - 4 * time.g_rate * kappa * (J @ bv)
        - 2 * g * kappa_rate * (weight @ bv)
        - 2 * g * kappa * (J @ plant.bv_rate)
        - g / 2 * kappa * (1 + plant.b0) * (J @ Omega)
    )
