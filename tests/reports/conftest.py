"""The synthetic record and its report, made once."""

import pytest
from intermit.reports import Record
from intermit.reports.build import report_files
from synthetic_record import make


@pytest.fixture(scope="session")
def record() -> Record:
    return make()


@pytest.fixture(scope="session")
def report(record: Record) -> dict[str, bytes]:
    """Every file of the record's report."""
    return report_files(record)
