"""One walk of a CasADi SX function's instruction list, for every backend.

The walk gives a neutral `Program`: named operations on numbered values, each value assigned
once. A backend brings a table from operation names to callables; floats, arrays, polynomials,
balls and symbolic expressions of other systems then all evaluate the same model.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from typing import Any, TypeVar, final

T = TypeVar("T")


class UnknownOperationError(ValueError):
    """An operation that a backend's table does not have."""


@final
@dataclass(frozen=True, slots=True)
class Step:
    """One operation: value `result` = `operation`(values `operands`).

    Attributes
    ----------
    operation : CasADi's name in lower case without prefix, e.g. "add", "sq", "twice", "inv"
    result : number of the value it defines
    operands : numbers of the values it uses
    """

    operation: str
    result: int
    operands: tuple[int, ...]


@final
@dataclass(frozen=True)
class Program:
    """A straight-line program in single-assignment form.

    Attributes
    ----------
    name : the function's name
    argument_sizes : number of elements of each argument (column-major)
    inputs : value number -> (argument, element)
    constants : value number -> float
    steps : operations, in an order in which they can be carried out
    results : for each result, the value number of each element (column-major); None is an exact 0
    value_count : number of values
    """

    name: str
    argument_sizes: tuple[int, ...]
    inputs: Mapping[int, tuple[int, int]]
    constants: Mapping[int, float]
    steps: tuple[Step, ...]
    results: tuple[tuple[int | None, ...], ...]
    value_count: int

    @property
    def operations(self) -> frozenset[str]:
        """Names of the operations used."""
        return frozenset(step.operation for step in self.steps)

    def last_uses(self) -> dict[int, int]:
        """Index of the last step that uses each value; len(steps) for a value that is a result."""
        last = {operand: i for i, step in enumerate(self.steps) for operand in step.operands}
        last.update({v: len(self.steps) for row in self.results for v in row if v is not None})
        return last


def walk(function: Any) -> Program:
    """Read the instruction list of a CasADi Function of SX type.

    Parameters
    ----------
    function : casadi.Function
        Built from SX expressions; sparse results are made dense, with exact zeros.

    Raises
    ------
    TypeError
        If the function has no scalar instruction list (an MX or external function).
    """
    if not function.is_a("SXFunction"):
        raise TypeError(f"function {function.name()}: expected one made of SX expressions")
    names = _operation_names()
    positions = [function.sparsity_in(i).find() for i in range(function.n_in())]
    found = [function.sparsity_out(i).find() for i in range(function.n_out())]
    results: list[list[int | None]] = [[None] * function.numel_out(i) for i in range(function.n_out())]
    inputs: dict[int, tuple[int, int]] = {}
    constants: dict[int, float] = {}
    steps: list[Step] = []
    work: dict[int, int] = {}
    count = 0
    for i in range(function.n_instructions()):
        operation = names[function.instruction_id(i)]
        source, target = function.instruction_input(i), function.instruction_output(i)
        if operation == "output":
            result, element = target
            results[result][found[result][element]] = work[source[0]]
            continue
        if operation == "input":
            argument, element = source
            inputs[count] = (argument, positions[argument][element])
        elif operation == "const":
            constants[count] = function.instruction_constant(i)
        else:
            steps.append(Step(operation, count, tuple(work[s] for s in source)))
        work[target[0]] = count
        count += 1
    sizes = tuple(function.numel_in(i) for i in range(function.n_in()))
    rows = tuple(tuple(row) for row in results)
    return Program(function.name(), sizes, inputs, constants, tuple(steps), rows, count)


def evaluate(
    program: Program,
    table: Mapping[str, Callable[..., T]],
    arguments: Sequence[Sequence[T]],
    constant: Callable[[float], T],
) -> list[list[T]]:
    """Run a program over any kind of number.

    Parameters
    ----------
    program : Program
        What to run.
    table : mapping
        Operation name -> callable on one or two numbers (see `operations`).
    arguments : sequence of sequences
        The numbers of each argument, `program.argument_sizes` of them.
    constant : callable
        Turns a float constant of the model into such a number (a float is an exact binary fraction).

    Returns
    -------
    list of list
        The elements of each result, in column-major order.

    Raises
    ------
    UnknownOperationError
        If the table lacks an operation, naming it.
    """
    check_arguments(program, [len(a) for a in arguments])
    check_operations(program, table, "this table")
    values: dict[int, T] = {v: arguments[a][e] for v, (a, e) in program.inputs.items()}
    values.update({v: constant(c) for v, c in program.constants.items()})
    for step in program.steps:
        values[step.result] = table[step.operation](*(values[o] for o in step.operands))
    zero = constant(0.0)
    return [[zero if v is None else values[v] for v in row] for row in program.results]


def check_operations(program: Program, table: Mapping[str, Any], backend: str) -> None:
    """Refuse a program that needs operations a table lacks."""
    missing = sorted(program.operations - set(table))
    if missing:
        raise UnknownOperationError(
            f"function {program.name} uses {', '.join(missing)}, which {backend} does not have; "
            f"it has {', '.join(sorted(table))}"
        )


def check_arguments(program: Program, sizes: Sequence[int]) -> None:
    """Refuse arguments of the wrong number or size."""
    if tuple(sizes) != program.argument_sizes:
        raise ValueError(
            f"function {program.name}: expected arguments of {program.argument_sizes} elements, "
            f"received {tuple(sizes)}"
        )


@cache
def _operation_names() -> dict[int, str]:
    """CasADi's operation codes by name."""
    import casadi as ca

    return {getattr(ca, k): k[3:].lower() for k in dir(ca) if k.startswith("OP_")}
