"""No simulated trajectory crosses a certified bound; and bounds raised by 3 per cent would be caught."""

import pytest
from floor_attack import attack, crossings, summary


def check_power(attacks):
    """The attack is not empty: most scenarios are certified, and an inflated floor would be caught."""
    found = summary(attacks)
    assert found["certified"] >= 0.8
    assert found["caught_at_3_percent"] >= 0.5


@pytest.mark.parametrize("seed", [3, 5])
def test_a_few_scenarios(seed):
    found = attack(seed)
    assert found.certified
    assert not crossings([found])


@pytest.mark.slow
@pytest.mark.parametrize("decade", range(6))
def test_sixty_scenarios(decade):
    attacks = [attack(seed) for seed in range(10 * decade, 10 * decade + 10)]
    assert not crossings(attacks)
    check_power(attacks)


@pytest.mark.soak
def test_three_hundred_scenarios():
    attacks = [attack(seed) for seed in range(1000, 1300)]
    assert not crossings(attacks)
    check_power(attacks)
