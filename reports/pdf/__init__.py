"""The same chapters typeset: vector figures, page numbers, contents, title block."""

from .document import pdf_document as pdf_document
