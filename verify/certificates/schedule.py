"""A schedule as certificates write it down."""

from __future__ import annotations

from ...models.schedule import Schedule


def schedule_data(schedule: Schedule) -> dict[str, object]:
    """The gain profile: knots, the distinct shapes, which shape each piece has, and the period."""
    profile = schedule.profile
    shapes = list(dict.fromkeys(profile.shapes))
    index = {shape: i for i, shape in enumerate(shapes)}
    data: dict[str, object] = {
        "knots": profile.knots,
        "shapes": shapes,
        "pieces": [index[shape] for shape in profile.shapes],
    }
    if schedule.period is not None:
        data["period"] = schedule.period
    return data
