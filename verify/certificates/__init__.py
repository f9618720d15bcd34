"""Certificates: proofs written to a file that the stand-alone checker proves anew."""

from .format import Certificate, as_text, certificate_text, exact_text

__all__ = ["Certificate", "as_text", "certificate_text", "exact_text"]
