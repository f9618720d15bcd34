"""Every value in a quantity's interval rounds to the digits shown; bounds are rounded the safe way."""

from decimal import Decimal

import pytest
from hypothesis import example, given
from hypothesis import strategies as st
from intermit.reports.numbers import number, unit_text, write
from intermit.reports.parts import figure_of, quantity

finite = st.floats(min_value=-1e12, max_value=1e12, allow_nan=False).filter(
    lambda x: x == 0 or abs(x) > 1e-12
)


def value(digits: str, exponent: int) -> Decimal:
    return Decimal(digits).scaleb(exponent)


@given(finite)
def test_a_lower_bound_is_never_shown_larger_than_it_is(x: float) -> None:
    shown = write(quantity("b", x, side="lower"))
    assert shown.relation == ">="
    assert value(shown.low, shown.exponent) <= Decimal(x)
    assert abs(value(shown.low, shown.exponent) - Decimal(x)) <= abs(Decimal(x)) * Decimal("1.01e-4")


@given(finite)
def test_an_upper_bound_is_never_shown_smaller_than_it_is(x: float) -> None:
    shown = write(quantity("b", x, side="upper"))
    assert value(shown.low, shown.exponent) >= Decimal(x)


@given(finite, st.floats(min_value=1e-12, max_value=2.0))
@example(100.0, 0.04)
def test_the_digits_shown_hold_for_the_whole_interval(x: float, spread: float) -> None:
    low, high = x - abs(x) * spread, x + abs(x) * spread
    shown = write(quantity("q", low, high, rigorous=True))
    if shown.high:
        assert value(shown.low, shown.exponent) <= Decimal(low)
        assert value(shown.high, shown.exponent) >= Decimal(high)
    elif low != high and not shown.relation:
        digits = value(shown.low, shown.exponent)
        half = Decimal(1).scaleb(digits.as_tuple().exponent) / 2
        assert abs(digits - Decimal(low)) <= half
        assert abs(digits - Decimal(high)) <= half


@given(finite, st.floats(min_value=1e-12, max_value=2.0))
@example(100.0, 0.0625)
def test_the_last_digit_of_a_figure_is_uncertain_by_one_at_most(x: float, spread: float) -> None:
    low, high = x - abs(x) * spread, x + abs(x) * spread
    shown = write(quantity("q", low, high))
    if not shown.high and low != high and not shown.relation:
        digits = value(shown.low, shown.exponent)
        last = Decimal(1).scaleb(digits.as_tuple().exponent)
        assert max(abs(digits - Decimal(low)), abs(digits - Decimal(high))) <= Decimal("1.5000001") * last


def test_zeros_before_the_point_are_digits_too() -> None:
    assert write(quantity("q", 93.75, 106.25)).ascii == "1.0e2"
    assert write(quantity("q", 99.7, 100.3)).ascii == "100"
    assert write(quantity("q", 100.0, 100.0)).ascii == "100"


def test_an_invented_digit_would_be_noticed() -> None:
    assert write(quantity("q", 0.01197, 0.01198, rigorous=True)).ascii == "0.0120"
    assert write(quantity("q", 0.0119761, 0.0119762, rigorous=True)).ascii == "0.011976"
    assert write(quantity("q", 0.01187, 0.01198)).ascii == "0.0119"


def test_enclosure_across_a_rounding_edge_is_an_interval() -> None:
    assert write(quantity("q", 0.134441, 0.134559, rigorous=True)).ascii == "[0.13444, 0.13456]"
    assert write(quantity("q", 25.0275, 25.0525)).ascii == "25.0"


@pytest.mark.parametrize(
    ("low", "high", "side", "text"),
    [
        (0.149646, None, "both", "0.149646 s"),
        (8.0, None, "both", "8 s"),
        (0.14736999, 1.0, "lower", "≥ 0.14736 s"),
        (0.1, 2.4400001, "upper", "≤ 2.4401 s"),
        (-0.5, 0.5, "both", "[−0.50, 0.50] s"),
        (1.0, 3.0, "both", "[1.0, 3.0] s"),
        (1.23456e-9, 1.23457e-9, "both", "1.23456×10⁻⁹ s"),
        (None, None, "both", "–"),
        (0.5, "inf", "both", "≥ 0.5 s"),
        (0.0, "inf", "upper", "– (no bound)"),
        (0.525, None, "lower", "≥ 0.525 s"),
        (0.3, None, "lower", "≥ 0.29999 s"),  # the double nearest to 0.3 is below it,
    ],
)
def test_known_cases(low: float, high: float, side: str, text: str) -> None:
    shown = write(quantity("q", low, high, unit="s", side=side))  # type: ignore[arg-type]
    assert shown.text == text


def test_a_figure_has_the_digits_it_was_given() -> None:
    assert write(figure_of("p", 0.0119761234, digits=6)).ascii in {"0.0119761", "0.011976"}
    assert write(figure_of("p", None, digits=6, unit="s")).missing


def test_plain_numbers_drop_trailing_zeros() -> None:
    assert [number(x) for x in (3.2, 8.01, 1e-7, 0.0, -2.5e9, 120.0)] == [
        "3.2",
        "8.01",
        "1e-7",
        "0",
        "-2.5e9",
        "120",
    ]


def test_units_are_typeset() -> None:
    assert unit_text("kg m^2/s^2") == "kg·m²/s²"
    assert unit_text("N m s") == "N·m·s"
