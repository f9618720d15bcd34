"""The title of the excitation claim says "within the table" of one that ends, and only of that."""

from fractions import Fraction as F

import pytest
from intermit.models.schedule import Ramps, Window, build_schedule
from intermit.verify.schedule.excitation import excitation_claim


@pytest.mark.parametrize("length", [F(9), F(1)])
def test_title_names_the_table_only_where_it_ends(length):
    table = [Window(F(8 * k), F(8 * k + 3)) for k in range(3)]
    shape = Ramps(F("0.2"), F("0.3"))
    ending = excitation_claim(build_schedule(table, shape), length)
    repeating = excitation_claim(build_schedule(table, shape, period=F(24)), length)
    assert ending.title == "g is persistently exciting within the table"
    assert repeating.title == "g is persistently exciting"
