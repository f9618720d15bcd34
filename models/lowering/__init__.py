"""One walk of the model's CasADi expressions; tables of operations turn it into other backends."""

from .arrays import ArrayFunction
from .blocks import BlockFunction
from .heyoka_table import HeyokaMissingError, heyoka_available
from .operations import FIELD, RING
from .samples import Backend, sample_function
from .scalar import emit_scalar
from .share import shared
from .walk import Program, Step, UnknownOperationError, evaluate, walk

__all__ = [
    "FIELD",
    "RING",
    "ArrayFunction",
    "Backend",
    "BlockFunction",
    "HeyokaMissingError",
    "Program",
    "Step",
    "UnknownOperationError",
    "emit_scalar",
    "evaluate",
    "heyoka_available",
    "sample_function",
    "shared",
    "walk",
]
