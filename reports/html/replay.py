"""What the replay needs: attitude and torque of each body at a few hundred instants."""

from __future__ import annotations

import numpy as np

from ..content.blocks import Body, Replay
from ..content.wording import short, visible
from .plotly import packed

FRAMES = 600
"""Instants kept per body; the page interpolates on the sphere between them."""


def replay_data(replay: Replay) -> dict[str, object]:
    """Bodies, windows and the box the body is drawn as."""
    return {
        "bodies": [_body(b) for b in replay.bodies],
        "windows": [list(w) for w in replay.windows],
        "box": _box(replay),
        "end": max(float(b.time[-1]) for b in replay.bodies),
    }


def _body(body: Body) -> dict[str, object]:
    index = np.unique(np.linspace(0, len(body.time) - 1, min(FRAMES, len(body.time))).round().astype(int))
    out: dict[str, object] = {"label": short(visible(body.label), 80), "time": packed(body.time[index])}
    out["quaternion"] = packed(body.quaternion[index].ravel())
    if body.torque is not None:
        out["torque"] = packed(body.torque[index].ravel())
    return out


def _box(replay: Replay) -> list[float]:
    """Half edges of a solid box drawn with the inertia's diagonal, longest edge 1."""
    if replay.inertia is None:
        return [1.0, 0.8, 0.6]
    d = [replay.inertia[i][i] for i in range(3)]
    squares = [max(sum(d) - 2 * d[i], 0.02 * sum(d)) for i in range(3)]
    largest = max(squares)
    return [round((s / largest) ** 0.5, 4) for s in squares]
