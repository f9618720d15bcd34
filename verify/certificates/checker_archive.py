"""The stand-alone checker as one file that Python runs: python -I -S checker.pyz FILE."""

from __future__ import annotations

import zipfile
from io import BytesIO
from pathlib import Path

from .. import checker

START = "import sys\n\nfrom checker import main\n\nsys.exit(main(sys.argv[1:]))\n"
EPOCH = (1980, 1, 1, 0, 0, 0)
"""Of every entry: the same sources make the same bytes."""


def checker_archive() -> bytes:
    """Return the zip application: the checker's own sources, its README, and three lines that start it."""
    folder = Path(checker.__file__).parent
    files = {"__main__.py": START.encode()}
    for path in sorted(folder.iterdir()):
        if path.suffix in (".py", ".md") and path.name != "__main__.py":
            files[f"checker/{path.name}"] = path.read_bytes()
    buffer = BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, content in files.items():
            archive.writestr(zipfile.ZipInfo(name, EPOCH), content, zipfile.ZIP_DEFLATED)
    return buffer.getvalue()
