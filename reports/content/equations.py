"""The equations a report sets: the plant's, and what each law of the record states of itself.

A record may come from anywhere, and Typst and LaTeX would carry out what stands in it. So an equation is set
only if it is built of the words of formulas; any other is shown as its author wrote it.
"""

from __future__ import annotations

import re
from collections.abc import Iterable

from ..record.runs import CaseEntry
from .blocks import Block, Equation, Equations, Verbatim
from .typeset import equation_svgs

PLANT = Equation(
    "Attitude and rate",
    r"dot(beta)_0 &= -1/2 thin vb(beta)_v dot vb(omega), \ "
    r"dot(vb(beta))_v &= 1/2 (beta_0 vb(omega) + vb(beta)_v times vb(omega)), \ "
    r"vb(J) dot(vb(omega)) &= -vb(omega) times vb(J) vb(omega) + g vb(u)",
    r"\begin{aligned}\dot\beta_0&=-\tfrac12\bm\beta_v\cdot\bm\omega,\\"
    r"\dot{\bm\beta}_v&=\tfrac12(\beta_0\bm\omega+\bm\beta_v\times\bm\omega),\\"
    r"\bm J\dot{\bm\omega}&=-\bm\omega\times\bm J\bm\omega+g\bm u\end{aligned}",
)
MAX_LENGTH = 2000
_TYPST = re.compile(r"(?:[A-Za-z0-9 .,;:+\-*/^_=<>|!'&()\[\]{}]|\\ )*")
_LATEX = re.compile(r"(?:[A-Za-z0-9 .,;:+\-*/^_=<>|!'&()\[\]{}]|\\[A-Za-z]+|\\[,;:!\\ |{}])*")
_TITLE = re.compile(r"[A-Za-z0-9 .,;:+\-*/=()']{1,200}")
_COMMANDS = frozenset(
    re.findall(
        r"\w+",
        """alpha beta gamma delta epsilon varepsilon zeta eta theta kappa lambda mu nu xi pi rho sigma tau phi
        varphi chi psi omega Gamma Delta Theta Lambda Xi Pi Sigma Phi Psi Omega dot ddot hat bar tilde bm
        mathrm frac tfrac sqrt top quad qquad times cdot pm le ge leq geq ne infty int sum max min sup inf sin
        cos tan tanh exp ln begin end left right bigl bigr big Bigl Bigr text to mapsto in partial""",
    )
)
_ENVIRONMENTS = frozenset({"aligned", "cases", "pmatrix", "bmatrix"})


def equation_blocks(cases: Iterable[CaseEntry]) -> tuple[Block, ...]:
    """The plant's equations and each law's, every one once; what cannot be set, as it is written."""
    chosen, literal = [PLANT], list[Block]()
    for case in cases:
        for entry in case.equations:
            equation = Equation(entry.title, entry.typst, entry.latex)
            if equation in chosen:
                continue
            if is_formula(equation) and _compiles(equation):
                chosen.append(equation)
            else:
                text = f"{equation.title}\n{equation.latex}"
                literal.append(Verbatim(f"{case.label}: the law as its author states it", text))
    return (Equations(tuple(chosen)), *literal)


def is_formula(equation: Equation) -> bool:
    """Whether an equation is built of the words of formulas alone, in both notations."""
    typst, latex = equation.typst, equation.latex
    if max(len(typst), len(latex)) > MAX_LENGTH or not _TITLE.fullmatch(equation.title):
        return False
    if not _TYPST.fullmatch(typst) or not _LATEX.fullmatch(latex) or "//" in typst or "/*" in typst:
        return False
    if set(re.findall(r"\\([A-Za-z]+)", latex.replace(r"\\", " "))) - _COMMANDS:
        return False
    return set(re.findall(r"\\(?:begin|end)\s*\{([^}]*)\}", latex)) <= _ENVIRONMENTS and _is_balanced(latex)


def _is_balanced(latex: str) -> bool:
    depth = 0
    for c in latex.replace(r"\{", "").replace(r"\}", ""):
        depth += {"{": 1, "}": -1}.get(c, 0)
        if depth < 0:
            return False
    return depth == 0 and re.findall(r"\\begin\{(\w+)\}", latex) == re.findall(r"\\end\{(\w+)\}", latex)


def _compiles(equation: Equation) -> bool:
    """Whether Typst sets it: a misspelt word must not cost the whole report."""
    try:
        equation_svgs((equation,))
    except Exception:  # whatever the compiler says of it (typst has no public class of its own for this)
        return False
    return True
