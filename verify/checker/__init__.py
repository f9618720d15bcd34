"""The stand-alone checker of certificate files: standard library only, exact rationals throughout.

    python -I -S verify/checker FILE

A certificate file is JSON, every number in it an exact string ("p/q" or a decimal):

    {"format": "intermit-certificate", "version": "1", "parts": [
      {"data": {...},                               what the claims of this part speak about
       "certificates": [{"kind": ..., "claim": {...}, "witness": {...}}, ...]}, ...]}

The checker proves each claim anew from the file alone: what a certificate says of itself counts
for nothing, and a field that no proof reads makes the file invalid. It prints each claim with
its data and VALID or INVALID with the reason. Exit code 0: everything is valid; 1: something is
not; 2: there is no such file. It imports nothing from the programs that write certificates.
README.md says what it trusts, and in which order to read it.
"""

from __future__ import annotations

from . import (
    filter_floor,
    filter_start,
    floquet,
    floquet_exact,
    lambda_conditions,
    lyapunov_counterexample,
    lyapunov_derivative,
    lyapunov_identity,
    peak_lower_bound,
    schedule_excitation,
    schedule_facts,
)
from .bernstein import Form
from .closed_loop import INERTIA, law_polynomials
from .command import main, report
from .exact_numbers import Invalid, Matrix, Vector, exact
from .filter_floor import cosine_below
from .floquet import monodromy, require_change
from .kinds import FORMAT, KINDS, VERSION, Finding, check_certificate, check_text
from .known_laws import compared_law
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
from .polynomials import Exponents, Poly, Ring, on_sphere, pick, run
from .reading import Node, parse
from .schedules import read_profile

__all__ = [
    "FORMAT",
    "INERTIA",
    "KINDS",
    "PEAK_BITS",
    "VERSION",
    "Exponents",
    "Finding",
    "Form",
    "Gauge",
    "Invalid",
    "Matrix",
    "Metrics",
    "Node",
    "PeakChart",
    "Poly",
    "RateProof",
    "Ring",
    "Transfer",
    "Vector",
    "as_solid",
    "check_certificate",
    "check_text",
    "coast_attitude",
    "compared_law",
    "components_above",
    "cosine_below",
    "cut_solid",
    "exact",
    "filter_floor",
    "filter_start",
    "floquet",
    "floquet_exact",
    "gaps",
    "inverse_matrix",
    "is_positive_definite",
    "is_positive_semidefinite",
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
    "norm",
    "on_sphere",
    "parse",
    "peak_lower_bound",
    "pick",
    "rate_polynomials",
    "read_potential",
    "read_profile",
    "report",
    "require_change",
    "rounding_units",
    "run",
    "schedule_excitation",
    "schedule_facts",
    "square_above",
]
