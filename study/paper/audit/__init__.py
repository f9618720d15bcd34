"""The audit of the paper's printed equations: each derived or refuted by computation.

Source of the equations: Ram & Akella, "Precision Attitude Stabilization with Intermittent
External Torque", AAS 21-402.
"""

from .errata import audit
from .item import AuditItem

__all__ = ["AuditItem", "audit"]
