"""The stand-alone checker of certificate files: standard library only, exact rationals throughout.

    python -I -S verify/checker [--with PART.py] FILE

A certificate file is JSON, every number in it an exact string ("p/q" or a decimal):

    {"format": "intermit-certificate", "version": "1", "parts": [
      {"data": {...},                               what the claims of this part speak about
       "certificates": [{"kind": ..., "claim": {...}, "witness": {...}}, ...]}, ...]}

The checker proves each claim anew from the file alone: what a certificate says of itself counts
for nothing, and a field that no proof reads makes the file invalid. It prints each claim with
its data and VALID or INVALID with the reason. Exit code 0: everything is valid; 1: something is
not; 2: there is no such file. A part from outside (a comparison system or a kind of certificate of
somebody else's) is read only if it is named with --with, and every claim that rests on it says so.
The checker imports nothing from the programs that write certificates.
README.md says what it trusts, and in which order to read it.
"""

from __future__ import annotations

from . import (
    adaptive,
    filter_floor,
    filter_start,
    floquet,
    floquet_exact,
    lambda_conditions,
    lyapunov_counterexample,
    lyapunov_derivative,
    lyapunov_identity,
    peak_lower_bound,
    persistence,
    robust_floor,
    schedule_excitation,
    schedule_facts,
)
from .bernstein import Form
from .closed_loop import ATTITUDE, INERTIA, RATE, Loop, Motion, law_polynomials, move, read_loop, same_law
from .command import main, report
from .comparison import (
    Bounds,
    Comparison,
    Conditions,
    Found,
    Setting,
    angle_factor,
    comparison,
    find_system,
    initial_values,
)
from .exact_numbers import Invalid, Matrix, Vector, exact, require, show
from .filter_floor import cosine_below
from .floor_bounds import Box, root_above, sliding_command
from .floquet import monodromy, require_change
from .kinds import FORMAT, KINDS, VERSION, Finding, Proof, check_certificate, check_text, kind
from .known_laws import augmented, gain_numbers, read_scaled
from .lyapunov_derivative import gaps
from .matrices import inverse_matrix, is_positive_definite, is_positive_semidefinite, matrix_product, norm
from .peak_chart import PeakChart, rate_polynomials
from .peak_coast import coast_attitude
from .peak_gauge import Gauge
from .peak_numbers import PEAK_BITS, length_interval
from .peak_rate import Metrics, RateProof
from .peak_separation import read_potential
from .peak_solids import as_solid, components_above, cut_solid, local, rounding_units, square_above
from .peak_transfer import Transfer
from .polynomials import Exponents, Poly, Ring, Triple, apply, cross, on_sphere, pick, run
from .reading import Node, parse
from .schedules import Profile, read_profile
from .tables import Part, read_part

__all__ = [
    "ATTITUDE",
    "FORMAT",
    "INERTIA",
    "KINDS",
    "PEAK_BITS",
    "RATE",
    "VERSION",
    "Bounds",
    "Box",
    "Comparison",
    "Conditions",
    "Exponents",
    "Finding",
    "Form",
    "Found",
    "Gauge",
    "Invalid",
    "Loop",
    "Matrix",
    "Metrics",
    "Motion",
    "Node",
    "Part",
    "PeakChart",
    "Poly",
    "Profile",
    "Proof",
    "RateProof",
    "Ring",
    "Setting",
    "Transfer",
    "Triple",
    "Vector",
    "adaptive",
    "angle_factor",
    "apply",
    "as_solid",
    "augmented",
    "check_certificate",
    "check_text",
    "coast_attitude",
    "comparison",
    "components_above",
    "cosine_below",
    "cross",
    "cut_solid",
    "exact",
    "filter_floor",
    "filter_start",
    "find_system",
    "floquet",
    "floquet_exact",
    "gain_numbers",
    "gaps",
    "initial_values",
    "inverse_matrix",
    "is_positive_definite",
    "is_positive_semidefinite",
    "kind",
    "lambda_conditions",
    "law_polynomials",
    "length_interval",
    "local",
    "lyapunov_counterexample",
    "lyapunov_derivative",
    "lyapunov_identity",
    "main",
    "matrix_product",
    "monodromy",
    "move",
    "norm",
    "on_sphere",
    "parse",
    "peak_lower_bound",
    "persistence",
    "pick",
    "rate_polynomials",
    "read_loop",
    "read_part",
    "read_potential",
    "read_profile",
    "read_scaled",
    "report",
    "require",
    "require_change",
    "robust_floor",
    "root_above",
    "rounding_units",
    "run",
    "same_law",
    "schedule_excitation",
    "schedule_facts",
    "show",
    "sliding_command",
    "square_above",
]
