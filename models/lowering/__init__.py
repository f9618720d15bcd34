"""One walk of the model's CasADi expressions; tables of operations turn it into other backends."""

from .arrays import ArrayFunction
from .operations import FIELD, RING
from .scalar import emit_scalar
from .share import shared
from .walk import Program, Step, UnknownOperationError, evaluate, walk

__all__ = [
    "FIELD",
    "RING",
    "ArrayFunction",
    "Program",
    "Step",
    "UnknownOperationError",
    "emit_scalar",
    "evaluate",
    "shared",
    "walk",
]
