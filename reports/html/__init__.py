"""One self-contained HTML page: no network, figures to zoom, bodies to turn."""

from .page import html_page as html_page
