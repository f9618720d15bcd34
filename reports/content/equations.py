"""The equations a report sets, in Typst's and LaTeX's notation.

They are words of the report, not a model: which of them are shown follows from the law's name.
"""

from __future__ import annotations

from collections.abc import Iterable

from .blocks import Equation

PLANT = Equation(
    "Attitude and rate",
    r"dot(beta)_0 &= -1/2 thin vb(beta)_v dot vb(omega), \ "
    r"dot(vb(beta))_v &= 1/2 (beta_0 vb(omega) + vb(beta)_v times vb(omega)), \ "
    r"vb(J) dot(vb(omega)) &= -vb(omega) times vb(J) vb(omega) + g vb(u)",
    r"\begin{aligned}\dot\beta_0&=-\tfrac12\bm\beta_v\cdot\bm\omega,\\"
    r"\dot{\bm\beta}_v&=\tfrac12(\beta_0\bm\omega+\bm\beta_v\times\bm\omega),\\"
    r"\bm J\dot{\bm\omega}&=-\bm\omega\times\bm J\bm\omega+g\bm u\end{aligned}",
)
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
FILTER_GAIN = Equation(
    "Persistence filter: gain and Lyapunov function",
    r"kappa &= 1/R, \ V &= R (2 (1 - beta_0) + vb(Omega)^top vb(J) vb(Omega))",
    r"\begin{aligned}\kappa&=1/R,\\"
    r"V&=R\,\bigl(2(1-\beta_0)+\bm\Omega^{\top}\bm J\bm\Omega\bigr)\end{aligned}",
)
ADAPTIVE_GAIN = Equation(
    "Adaptive scaling: gain and Lyapunov function",
    r"kappa &= k, quad dot(k) = gamma R g^2 ((1 + beta_0) vb(Omega)^top vb(J) vb(Omega) "
    r"+ 2 |vb(beta)_v|^2), \ "
    r"V &= 2 (1 - beta_0) R + R vb(Omega)^top vb(J) vb(Omega) + (k - k^*)^2 / (2 gamma)",
    r"\begin{aligned}\kappa&=k,\qquad\dot k=\gamma Rg^2\bigl((1+\beta_0)\bm\Omega^{\top}\bm J\bm\Omega"
    r"+2|\bm\beta_v|^2\bigr),\\"
    r"V&=2(1-\beta_0)R+R\,\bm\Omega^{\top}\bm J\bm\Omega+\frac{(k-k^*)^2}{2\gamma}\end{aligned}",
)


def equations_for(laws: Iterable[str]) -> tuple[Equation, ...]:
    """Choose the equations: the plant's always, each built-in law's own if a case is called by it."""
    words = " ".join(laws).lower().replace("-", "_")
    filtered, adaptive = "persistence" in words, "adaptive" in words
    chosen = [PLANT]
    if filtered or adaptive:
        chosen += [FILTER, TORQUE]
    return tuple(chosen + [FILTER_GAIN] * filtered + [ADAPTIVE_GAIN] * adaptive)
