"""What a new user starts from: a commented scenario, and the paper's examples."""

from __future__ import annotations

from pathlib import Path

from ..reports.whole_files import write_whole
from .errors import ScenarioError

TEMPLATE = """\
# A scenario for intermit. Units are SI; angles in degrees where the key says _deg.
# Numbers are kept exactly as written: 0.1 means one tenth, not the nearest float.
# Every key is described in docs/scenario.md; unknown keys are refused.
name = "My spacecraft"
# extends = "base.toml"          # take every table that this file does not give from another file

[spacecraft]
name = "bus"
inertia = [[3.05, 0.14, 0.05],   # kg m^2, body frame, about the centre of mass; J12 = -integral of x y
           [0.14, 2.66, 0.12],
           [0.05, 0.12, 2.18]]
# inertia_tolerance = 0.02       # kg m^2: every entry known to +- this; proofs then cover the interval

[schedule]                       # when the thrusters give full thrust: one of four forms
period = 8                       # 1. one window a period: [8k + 0.01, 8k + 3.21] s, for ever ...
on = 0.01
on_time = 3.2
# count = 7                      #    ... or only seven times
# windows = [[0.01, 3.21], [8.01, 11.21]]   # 2. a table of [on, off], s; finite unless `period` repeats it
# csv = "windows.csv"            # 3. the same table as a CSV: on,off
# thrust = { csv = "thrust.csv", zero_below = 0.02 }   # 4. measured samples: time,thrust
shape = "hermite"                # or "hermite-as-printed", or "ramps" with ramp_up and ramp_down, s
thruster_rise = 0.01             # s before `on` in which the thrust is uncertain: g must be 0 there
thruster_fall = 0.01             # s after `off`, likewise

[initial]                        # where a run starts
axis = [1, 1, 1]
angle_deg = 120                  # or: quaternion = [0.5, 0.5, 0.5, 0.5], scalar first
rate = [0, 0, 0]                 # rad/s, body frame

[initial_set]                    # the starts that a certificate speaks of (default: just the one above)
max_angle_deg = 120              # error angle 2 acos b0
max_weighted_rate = 0.3          # sqrt(w' J w), sqrt(kg m^2)/s; or max_rate = ..., rad/s

# [target]                       # attitude to reach; the identity unless given
# axis = [0, 0, 1]
# angle_deg = 30

[[law]]                          # as many laws as you like; `intermit compare` puts them side by side
type = "adaptive-scaling"        # or "persistence-filter", "quaternion-pd", "user"
label = "adaptive"
lambda = 0.525                   # filter bandwidth, 1/s
gamma = 0.1                      # learning rate, 1/(kg m^2 s)
R0 = 1.0                         # initial filter state R(0), s
k0 = 0.2                         # initial gain k(0), 1/s

[[law]]
type = "persistence-filter"
label = "persistence filter"
lambda = 0.525
R0 = 1.0

# [[law]]                        # your own law: a subclass of intermit.models.laws.Law
# type = "user"
# file = "my_law.py"
# class = "MyLaw"
# parameters = { stiffness = 0.2 }

[tolerance]                      # settled: within both, for good
attitude = 0.01                  # |bv|
rate = 0.01                      # |w|, rad/s

[simulation]
horizon = 56                     # s

# [limits]
# torque = 2.0                   # N m that the applied torque must not exceed
# norm = "component"             # largest component, or "euclidean"

# [check]
# claims = ["schedule.order", "schedule.smooth"]   # which verdicts decide the exit code
# samples = 1048576              # states drawn for the derivative bound
# seed = 1
# pe_window = 8                  # s: length of the excitation window

[optimum]
final_time = 51.21               # s: at rest at the target by then
"""
"""The commented scenario that `intermit init` writes; it loads as it stands."""


def example_files() -> tuple[Path, ...]:
    """Return the example scenarios and the files they name, as installed with the package."""
    folder = Path(__file__).resolve().parent.parent / "examples"
    found = (p for p in folder.iterdir() if p.is_file() and p.suffix in {".toml", ".csv", ".py"})
    return tuple(sorted(found))


def write_new(path: Path, text: str) -> None:
    """Write a file that must not exist yet.

    Raises
    ------
    ScenarioError
        If it exists (it is never overwritten) or cannot be written.
    """
    try:
        write_whole(path, text, new=True)
    except FileExistsError:
        raise ScenarioError(str(path), "exists already: it is left as it is") from None
    except OSError as error:
        raise ScenarioError(str(path), f"cannot be written: {error.strerror or error}") from None


def write_template(path: str | Path) -> Path:
    """Write the commented scenario to a new file and return its path."""
    target = Path(path)
    write_new(target, TEMPLATE)
    return target


def write_examples(folder: str | Path) -> tuple[Path, ...]:
    """Copy the examples into a folder (made if missing) and return their paths; nothing is overwritten."""
    target = Path(folder)
    existing = [target / p.name for p in example_files() if (target / p.name).exists()]
    if existing:
        raise ScenarioError(str(existing[0]), "exists already: it is left as it is")
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise ScenarioError(str(target), f"cannot be made: {error.strerror or error}") from None
    written = []
    for path in example_files():
        write_new(target / path.name, path.read_text(encoding="utf-8"))
        written.append(target / path.name)
    return tuple(written)
