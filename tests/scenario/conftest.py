"""A small sound scenario that tests break one key at a time."""

import pytest
from intermit.scenario import ScenarioError, load_scenario

SOUND = {
    "spacecraft": "inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]",
    "schedule": "windows = [[0.01, 3.21], [8.01, 11.21], [16.01, 19.21]]",
    "initial": "quaternion = [0.5, 0.5, 0.5, 0.5]",
    "[law]": 'type = "persistence-filter"\nlambda = 0.525\nR0 = 1',
}


class Workshop:
    """Writes variants of the sound scenario into a folder and loads them."""

    def __init__(self, folder):
        self.folder = folder

    def write(self, name="scenario.toml", **tables):
        parts = dict(SOUND)
        head = tables.pop("head", "")
        for key, text in tables.items():
            parts["[law]" if key == "law" else key] = text
        body = "".join(f"[{key}]\n{text}\n" for key, text in parts.items() if text is not None)
        path = self.folder / name
        path.write_text(f"{head}\n{body}", encoding="utf-8")
        return path

    def load(self, **tables):
        return load_scenario(self.write(**tables))

    def complaint(self, **tables):
        with pytest.raises(ScenarioError) as caught:
            self.load(**tables)
        text = str(caught.value)
        assert "\n" not in text
        return text


@pytest.fixture
def workshop(tmp_path):
    return Workshop(tmp_path)
