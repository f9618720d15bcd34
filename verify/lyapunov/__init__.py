"""Lyapunov functions: identities, conditions on lambda, certified decay of a storage function."""

from .candidates import Candidate, NoStorageError, candidate
from .claims import certificates_of, lyapunov_claims
from .conditions import paper_condition, sharp_condition, sharp_threshold
from .decay import best_weight, derivative_claim, rate_claim
from .derivative import DecayCertificate, NoCertificateError, certify_decay
from .exact_states import ExactDerivative, ExactState
from .falsify import Falsification, Falsifier, falsify
from .identity import identity_certificate, identity_claim

__all__ = [
    "Candidate",
    "DecayCertificate",
    "ExactDerivative",
    "ExactState",
    "Falsification",
    "Falsifier",
    "NoCertificateError",
    "NoStorageError",
    "best_weight",
    "candidate",
    "certificates_of",
    "certify_decay",
    "derivative_claim",
    "falsify",
    "identity_certificate",
    "identity_claim",
    "lyapunov_claims",
    "paper_condition",
    "rate_claim",
    "sharp_condition",
    "sharp_threshold",
]
