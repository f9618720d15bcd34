"""The margin of a channel is a size at which the claims were proved, and at twice of which they were not."""

from dataclasses import dataclass, replace
from fractions import Fraction as F
from types import SimpleNamespace

import pytest
from intermit.models.uncertainty import Uncertainty
from intermit.verify.flow.inequalities import Size
from intermit.verify.robust.margins import channel_margins

STATED = Uncertainty(inertia_relative=F("0.01"), disturbance=F("0.001"))


@dataclass(frozen=True)
class Question:
    mission: SimpleNamespace

    def about(self, uncertainty):
        return replace(self, mission=SimpleNamespace(uncertainty=uncertainty))


@pytest.mark.parametrize("factor", [F(1), F(3), F(7)])
def test_the_margin_was_proved_and_is_near_the_largest(factor):
    def is_proved(question):
        asked = question.mission.uncertainty
        return asked.inertia_relative <= F("0.01") * factor and asked.disturbance <= F("0.001")

    question = Question(SimpleNamespace(uncertainty=STATED))
    margins = {q.name: q for q in channel_margins(question, is_proved)}
    assert set(margins) == {"robust_inertia_relative", "robust_disturbance"}
    assert margins["robust_disturbance"].low == pytest.approx(0.001)
    relative = F(margins["robust_inertia_relative"].low)
    assert F("0.01") * factor / 2 <= relative <= F("0.01") * factor
    assert margins["robust_disturbance"].unit == "N m"


def test_the_size_of_a_quotient_is_the_quotient_of_sizes():
    assert 3 / Size(2) == Size(3) / -2 == 1.5
    assert 3 / Size(0) == 0
