"""The list: every misprint found in the paper, in the order of its numbers."""

from __future__ import annotations

from collections.abc import Callable

from .bounds import bounding_step, filter_ceiling, filter_floor, final_bound
from .control import augmented_dynamics, filter_law, update_law
from .item import AuditItem
from .tables import first_row, kinematics, merged_rows, overrun

ERRATA: tuple[Callable[[], AuditItem], ...] = (
    update_law,
    augmented_dynamics,
    filter_law,
    final_bound,
    merged_rows,
    first_row,
    bounding_step,
    kinematics,
    overrun,
    filter_ceiling,
    filter_floor,
)


def audit(progress: Callable[[str, float], None] | None = None) -> tuple[AuditItem, ...]:
    """Enter the printed equations as printed, and refute or derive each by computation."""
    items = []
    for i, erratum in enumerate(ERRATA):
        if progress is not None:
            progress(f"E{i + 1}", i / len(ERRATA))
        items.append(erratum())
    return tuple(items)
