"""The synthetic record, made once."""

import pytest
from intermit.reports import Record
from synthetic_record import make


@pytest.fixture(scope="session")
def record() -> Record:
    return make()
