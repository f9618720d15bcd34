"""The plotting script shipped in the page is the file its hash names, with its licence beside it."""

import hashlib
from importlib.resources import files


def test_the_script_has_its_hash_and_licence() -> None:
    vendor = files("intermit.reports").joinpath("vendor")
    lines = vendor.joinpath("SHA256SUMS").read_text(encoding="ascii").split()
    for digest, name in zip(lines[::2], lines[1::2], strict=True):
        assert hashlib.sha256(vendor.joinpath(name).read_bytes()).hexdigest() == digest
    assert "MIT" in vendor.joinpath("plotly.LICENSE").read_text(encoding="utf-8")
