"""Text, numbers and cells for LaTeX, with only booktabs, amsmath and bm in mind."""

from __future__ import annotations

from unicodedata import normalize

from ..content.blocks import Cell, MatrixCell
from ..content.wording import visible
from ..numbers import ROOT, number, write
from ..record.claims import QuantityEntry
from ..record.tables import CodeCell, VerdictCell
from .letters import PAIRS, letter

SPECIAL = {
    "\\": r"\textbackslash{}",
    "{": r"\{",
    "}": r"\}",
    "$": r"\$",
    "&": r"\&",
    "#": r"\#",
    "%": r"\%",
    "_": r"\_",
    "^": r"\textasciicircum{}",
    "~": r"\textasciitilde{}",
    "<": r"\textless{}",
    ">": r"\textgreater{}",
    "|": r"\textbar{}",
    '"': r"\textquotedbl{}",
    "'": r"\textquotesingle{}",
    "`": r"\textasciigrave{}",
    "-": "{-}",
    ",": "{,}",
    "[": "{[}",
    "]": "{]}",
    "*": "{*}",
    "?": "{?}",
    "!": "{!}",
    "/": r"/\allowbreak{}",
    "\n": r" \textbar{} ",
    "\t": " ",
}
_LETTERS = (
    "α alpha β beta γ gamma δ delta ε epsilon ζ zeta η eta θ theta ι iota κ kappa λ lambda μ mu ν nu ξ xi "
    "π pi ρ rho σ sigma τ tau υ upsilon φ phi χ chi ψ psi ω omega Γ Gamma Δ Delta Θ Theta Λ Lambda Ξ Xi Π Pi "
    "Σ Sigma Υ Upsilon Φ Phi Ψ Psi Ω Omega"
)
_PAIRS = _LETTERS.split()
GREEK = dict(zip(_PAIRS[::2], _PAIRS[1::2], strict=True))
MATHS = {
    "≥": r"\ge",
    "≤": r"\le",
    "−": "-",
    "×": r"\times",
    "±": r"\pm",
    "·": r"\cdot",
    "→": r"\to",
    "∞": r"\infty",
    "≈": r"\approx",
    "°": r"^\circ",
    "′": "'",
} | {c: "\\" + name for c, name in GREEK.items()}
WORDS = {"–": "--", "—": "---", "…": r"\ldots{}", "‹": r"\textless{}", "›": r"\textgreater{}", "\u00a0": "~"}
SUPERSCRIPTS = dict(zip("⁰¹²³⁴⁵⁶⁷⁸⁹⁻", "0123456789-", strict=True))
SUBSCRIPTS = dict(zip("₀₁₂₃₄₅₆₇₈₉", "0123456789", strict=True))
BREAK_EVERY = 12


def text(value: str) -> str:
    """Text that LaTeX sets as it is written; a character pdflatex cannot set stands as [U+6F22]."""
    out, run = [], 0
    for c in normalize("NFC", visible(value)):
        out.append(_character(c))
        run = 0 if c.isspace() else run + 1
        if run % BREAK_EVERY == 0 and run:
            out.append(r"\allowbreak{}")
    return "".join(out)


def _character(c: str) -> str:
    if c in SPECIAL:
        return SPECIAL[c]
    if c.isascii() and c.isprintable():
        return c
    if c in MATHS:
        return rf"\ensuremath{{{MATHS[c]}}}"
    if c in WORDS:
        return WORDS[c]
    if c in SUPERSCRIPTS:
        return rf"\ensuremath{{^{{{SUPERSCRIPTS[c]}}}}}"
    if c in SUBSCRIPTS:
        return rf"\ensuremath{{_{{{SUBSCRIPTS[c]}}}}}"
    if c in PAIRS:
        return "".join(_character(part) for part in PAIRS[c])
    return letter(c) or rf"{{[}}U+{ord(c):04X}{{]}}"


def unit(name: str) -> str:
    r"""Set a unit upright: "kg m^2" is \mathrm{kg\,m^{2}} (in maths)."""
    out, i = "", 0
    while i < len(name):
        c = name[i]
        root = ROOT.match(name, i)
        if root and not name[:i][-1:].isalpha():
            out += rf"\sqrt{{\mathrm{{{root[1]}}}}}"
            i = root.end()
            continue
        if c == "^" and i + 1 < len(name) and (name[i + 1].isdigit() or name[i + 1] == "-"):
            j = i + 2
            while j < len(name) and name[j].isdigit():
                j += 1
            out += f"^{{{name[i + 1 : j]}}}"
            i = j
            continue
        out += (
            r"\," if c == " " else c if c.isascii() and (c.isalnum() or c == "/") else rf"\text{{{text(c)}}}"
        )
        i += 1
    return rf"\mathrm{{{out}}}"


def quantity(value: QuantityEntry, *, with_unit: bool = True) -> str:
    """Set a quantity in maths, with the digits it deserves and no more."""
    written = write(value, unit=with_unit)
    if written.missing:
        return "--" + (f" ({text(written.note)})" if written.note else "")
    relation = {"": "", ">=": r"\ge ", "<=": r"\le "}[written.relation]
    body = f"[{written.low},\\,{written.high}]" if written.high else written.low
    power = rf"\times 10^{{{written.exponent}}}" if written.exponent else ""
    tail = r"\," + unit(written.unit) if written.unit else ""
    return f"${relation}{body}{power}{tail}$"


def cell(value: Cell, column_unit: str = "") -> str:
    """Set one table cell."""
    if value is None:
        return "--"
    if isinstance(value, str):
        return text(value)
    if isinstance(value, VerdictCell):
        return rf"\textsc{{{value.verdict.lower()}}}"
    if isinstance(value, CodeCell):
        return rf"\texttt{{{text(value.code)}}}"
    if isinstance(value, MatrixCell):
        rows = r" \\ ".join(" & ".join(number(x, 12) for x in row) for row in value.matrix)
        return rf"$\begin{{bmatrix}} {rows} \end{{bmatrix}}\,{unit(value.unit)}$"
    return quantity(value, with_unit=not column_unit or column_unit != value.unit)
