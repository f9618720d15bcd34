"""Messages that compare two numbers never print them alike."""

from fractions import Fraction as F

import pytest
from intermit.models.apart import apart
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule


@pytest.mark.parametrize(
    ("left", "right", "texts"),
    [
        (8, 8, ("8", "8")),
        (F("3.21"), F(3), ("3.21", "3")),
        (0.3, 0.30000000000000004, ("0.3", "0.30000000000000004")),
        (F("0.3"), F("0.3") + F(1, 10**20), ("0.3", "0.30000000000000000001")),
        (F(1, 3), F(1, 3) + F(1, 10**9), ("0.333333333", "0.333333334")),
    ],
)
def test_as_many_digits_as_it_takes(left, right, texts):
    assert apart(left, right) == texts


def test_messages_of_windows_and_inertia_show_the_difference():
    tiny = F(1, 10**15)
    with pytest.raises(ValueError, match=r"ends \(3 s\) after window 2 begins \(2\.999999999999999 s\)"):
        build_schedule([Window(F(1), F(3)), Window(F(3) - tiny, F(4))], Hermite())
    with pytest.raises(ValueError, match=r"ends \(8\.000000000000001 s\) after the period \(8 s\)"):
        build_schedule([Window(F(1), F(8) + tiny)], Hermite(), period=F(8))
    with pytest.raises(ValueError, match=r"is 0\.1, entry \(1,2\) is 0\.1000000001"):
        RigidBody.from_rows([[3, "0.1000000001", 0], ["0.1", 2, 0], [0, 0, 2]])
