"""The synthetic record and its report, made once; what Hypothesis draws is the same every time."""

import pytest
from hypothesis import HealthCheck, settings
from intermit.reports import Record
from intermit.reports.build import report_files
from synthetic_record import make

# no seed of the day, and no clock: a loaded machine is no failure
settings.register_profile(
    "fixed",
    derandomize=True,
    max_examples=500,
    deadline=None,
    suppress_health_check=[HealthCheck.too_slow],
)
settings.load_profile("fixed")


@pytest.fixture(scope="session")
def record() -> Record:
    return make()


@pytest.fixture(scope="session")
def report(record: Record) -> dict[str, bytes]:
    """Every file of the record's report."""
    return report_files(record)
