"""A report sets what each law states of itself; in a record nothing else can pass for an equation."""

import pytest
from intermit.models.laws import LAWS, Equation
from intermit.reports.content.blocks import Equations, Verbatim
from intermit.reports.content.equations import PLANT, equation_blocks, is_formula
from intermit.reports.record.runs import CaseEntry, EquationEntry

LAW_EQUATIONS = [(name, e) for name, law in LAWS.items() for e in law.equations]


def case(name, *equations):
    stated = tuple(EquationEntry(title=e.title, typst=e.typst, latex=e.latex) for e in equations)
    return CaseEntry(key=name, label=name, law=name, equations=stated)


def set_of(*cases):
    return [
        e.latex for block in equation_blocks(cases) if isinstance(block, Equations) for e in block.equations
    ]


@pytest.mark.parametrize("name", LAWS)
def test_every_law_states_its_equations_and_they_are_set(name):
    law = LAWS[name]
    assert set_of(case(name, *law.equations)) == [PLANT.latex, *(e.latex for e in law.equations)]


def test_a_misprint_is_shown_as_printed():
    printed = "".join(set_of(case("x", *LAWS["adaptive-scaling-as-printed"].equations)))
    correct = "".join(set_of(case("x", *LAWS["adaptive-scaling"].equations)))
    assert r"-2|\bm\beta_v|" in printed
    assert r"+2a|\bm\beta_v|^2" not in printed
    assert r"+2a|\bm\beta_v|^2" in correct


def test_an_equation_of_two_laws_is_set_once():
    both = [case(name, *LAWS[name].equations) for name in ("adaptive-scaling", "persistence-filter")]
    assert len(set_of(*both)) == len(set(set_of(*both)))


IDS = [f"{name}: {equation.title}" for name, equation in LAW_EQUATIONS]


@pytest.mark.parametrize(("name", "equation"), LAW_EQUATIONS, ids=IDS)
def test_shipped_equations_are_formulas(name, equation):
    assert is_formula(Equation(equation.title, equation.typst, equation.latex)), name


HOSTILE = {
    "code": Equation("t", '#read("/etc/passwd")', "x"),
    "end of math": Equation("t", "x $ #sys.version $ y", "x"),
    "comment": Equation("t", "x // y", "x"),
    "input": Equation("t", "x", r"\input{/etc/passwd}"),
    "write": Equation("t", "x", r"\immediate\write18{ls}"),
    "definition": Equation("t", "x", r"\def\x{\x}"),
    "environment": Equation("t", "x", r"\begin{document}\end{document}"),
    "end of the equation": Equation("t", "x", r"x\end{equation}\begin{equation}"),
    "unbalanced": Equation("t", "x", "x}{"),
    "title": Equation("t\n\\input{x}", "x", "x"),
    "long": Equation("t", "x" * 3000, "x"),
}


@pytest.mark.parametrize("equation", HOSTILE.values(), ids=HOSTILE)
def test_what_is_no_formula_is_shown_and_not_set(equation):
    assert not is_formula(equation)
    blocks = equation_blocks([case("mine", equation)])
    assert [type(block) for block in blocks] == [Equations, Verbatim]


def test_a_misspelt_word_does_not_cost_the_report():
    blocks = equation_blocks([case("mine", Equation("Torque", "alhpa + 1", r"\alpha+1"))])
    assert isinstance(blocks[-1], Verbatim)
    assert r"\alpha+1" in blocks[-1].text
