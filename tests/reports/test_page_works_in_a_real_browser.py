"""In headless Chromium: zoom, hover, legend, theme, replay; no request, no error, no axe violation."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from intermit.reports import Record
from intermit.reports.content.chapters import chapters
from intermit.reports.content.heading import heading
from intermit.reports.html import html_page
from outside_tools import need, need_module
from respoken import respoken

pytestmark = [pytest.mark.browser, pytest.mark.slow]
ARGUMENTS = (
    "--no-sandbox --disable-gpu --disable-quic --no-first-run --disable-background-networking "
    "--disable-component-update --disable-sync"
)


@pytest.fixture(scope="module")
def chromium() -> Iterator[Any]:
    path = need("chromium")
    need_module("playwright")
    from playwright.sync_api import sync_playwright

    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=ARGUMENTS.split())
        yield browser
        browser.close()


@pytest.fixture(scope="module")
def report(record: Record, tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("page") / "report.html"
    path.write_text(html_page(heading(record), chapters(record)), encoding="utf-8")
    return path


class Visit:
    """An open page and everything it asked for or complained about."""

    def __init__(self, browser: Any, path: Path, **options: Any) -> None:
        self.context = browser.new_context(offline=True, **options)
        self.page = self.context.new_page()
        self.requests: list[str] = []
        self.complaints: list[str] = []
        self.page.on("request", lambda r: self.requests.append(r.url))
        self.page.on(
            "console", lambda m: self.complaints.append(m.text) if m.type in {"error", "warning"} else None
        )
        self.page.on("pageerror", lambda e: self.complaints.append(str(e)))
        self.page.goto(path.as_uri())
        self.page.evaluate("window.intermit.drawAll()")
        self.page.wait_for_selector(".plot .main-svg")

    def close(self) -> None:
        self.context.close()
        outside = [u for u in self.requests[1:] if not u.startswith(("data:", "blob:"))]
        assert not outside
        assert not self.complaints


@pytest.fixture
def visit(chromium: Any, report: Path) -> Iterator[Visit]:
    opened = Visit(chromium, report, viewport={"width": 1280, "height": 900}, color_scheme="light")
    yield opened
    opened.close()


def plot(visit: Visit, key: str) -> Any:
    found = visit.page.locator(f"#figure-{key} .plot")
    found.scroll_into_view_if_needed()
    return found


def x_range(visit: Visit, key: str) -> list[float]:
    found: list[float] = visit.page.evaluate(
        f"document.querySelector('#figure-{key} .plot').layout.xaxis.range.slice()"
    )
    return found


def test_the_answer_is_on_the_first_screen(visit: Visit) -> None:
    for words in ("10 claims asked", "R stays positive", "certified floor of R"):
        box = visit.page.get_by_text(words).first.bounding_box()
        assert box["y"] + box["height"] < 900


def test_drag_zooms_neighbours_and_double_click_returns(visit: Visit) -> None:
    before = x_range(visit, "torque-1")
    box = plot(visit, "torque-1").locator(".nsewdrag").bounding_box()
    mouse = visit.page.mouse
    mouse.move(box["x"] + 0.2 * box["width"], box["y"] + 60)
    mouse.down()
    mouse.move(box["x"] + 0.5 * box["width"], box["y"] + 60, steps=5)
    mouse.up()
    visit.page.wait_for_timeout(400)
    after = x_range(visit, "torque-1")
    assert after[1] - after[0] < 0.5 * (before[1] - before[0])
    assert x_range(visit, "torque-2") == pytest.approx(after)
    mouse.dblclick(box["x"] + 0.3 * box["width"], box["y"] + 60)
    visit.page.wait_for_timeout(600)
    assert x_range(visit, "torque-1") == pytest.approx(before)
    assert x_range(visit, "torque-2") == pytest.approx(before)


def test_keys_zoom_move_and_reset_a_figure(visit: Visit) -> None:
    plot(visit, "torque-1").focus()
    before = x_range(visit, "torque-1")
    for key in ("+", "+", "ArrowRight"):
        visit.page.keyboard.press(key)
        visit.page.wait_for_timeout(200)
    after = x_range(visit, "torque-1")
    assert after[1] - after[0] < 0.5 * (before[1] - before[0])
    assert after[0] > before[0]
    visit.page.keyboard.press("0")
    visit.page.wait_for_timeout(200)
    assert x_range(visit, "torque-1") == pytest.approx(before)
    assert "zoom" in plot(visit, "torque-1").get_attribute("aria-description")


def test_hover_shows_the_values(visit: Visit) -> None:
    box = plot(visit, "torque-2").locator(".nsewdrag").bounding_box()
    visit.page.mouse.move(box["x"] + 0.15 * box["width"], box["y"] + 70)
    visit.page.wait_for_selector("#figure-torque-2 .hoverlayer text")
    shown = visit.page.locator("#figure-torque-2 .hoverlayer").text_content()
    assert "x :" in shown
    assert "z :" in shown


def test_the_legend_hides_a_line(visit: Visit) -> None:
    plot(visit, "torque-1").locator(".legendtoggle").first.click()
    visit.page.wait_for_timeout(600)
    assert (
        visit.page.evaluate("document.querySelector('#figure-torque-1 .plot').data[0].visible")
        == "legendonly"
    )


def test_theme_button_changes_figures_and_keeps_the_zoom(visit: Visit) -> None:
    visit.page.evaluate(
        "Plotly.relayout(document.querySelector('#figure-torque-1 .plot'), {'xaxis.range': [1, 9]})"
    )
    ground = "getComputedStyle(document.body).backgroundColor"
    light = visit.page.evaluate(ground)
    ink = "document.querySelector('#figure-torque-1 .plot').layout.font.color"
    colour = visit.page.evaluate(ink)
    button = visit.page.locator("#theme")
    button.click()
    button.click()
    assert visit.page.evaluate(ground) != light
    assert visit.page.evaluate(ink) != colour
    assert "dark" in button.get_attribute("aria-label")
    assert x_range(visit, "torque-1") == pytest.approx([1, 9])


def test_the_replay_follows_slider_keys_and_clock(visit: Visit) -> None:
    slider = visit.page.locator(".replay .time")
    slider.scroll_into_view_if_needed()
    shape = "document.querySelector('.stage polygon[fill-opacity]').getAttribute('points')"
    before = visit.page.evaluate(shape)
    slider.focus()
    for _ in range(30):
        visit.page.keyboard.press("ArrowRight")
    assert visit.page.evaluate(shape) != before
    clock = visit.page.locator(".replay .clock")
    assert clock.inner_text() == "t = 1.68 s, thruster window open"
    assert slider.get_attribute("aria-valuetext") == clock.inner_text()
    assert "thrusters on" in visit.page.locator(".lamp").first.inner_text()
    slider.fill("100")
    assert clock.inner_text() == "t = 5.60 s, thruster window closed"
    assert visit.page.locator(".lamp").first.inner_text() == "○ thrusters off"
    assert visit.page.locator(".stage figure").count() == 4


def test_the_replay_plays_and_pauses(visit: Visit) -> None:
    play = visit.page.locator(".replay .play")
    visit.page.locator(".replay .speed").select_option("1")
    play.click()
    for _ in range(100):
        visit.page.wait_for_timeout(100)
        if int(visit.page.locator(".replay .time").input_value()) > 2:
            break
    else:
        pytest.fail("the slider did not move in ten seconds")
    play.click()
    stopped = visit.page.locator(".replay .time").input_value()
    visit.page.wait_for_timeout(200)
    assert visit.page.locator(".replay .time").input_value() == stopped


def test_no_button_sends_data_away(visit: Visit) -> None:
    titles = visit.page.evaluate(
        "Array.from(document.querySelectorAll('.modebar-btn')).map(b => b.dataset.title)"
    )
    assert titles
    assert not [t for t in titles if "hare" in t or "loud" in t or "dit" in t]


@pytest.mark.parametrize("scheme", ["light", "dark"])
@pytest.mark.parametrize("width", [1280, 390])
def test_axe_finds_nothing(chromium: Any, report: Path, scheme: str, width: int) -> None:
    need_module("axe_playwright_python")
    from axe_playwright_python.sync_playwright import Axe

    opened = Visit(
        chromium, report, viewport={"width": width, "height": 900}, color_scheme=scheme, bypass_csp=True
    )
    opened.page.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
    results = Axe().run(opened.page)
    violations = [(v["id"], v["nodes"][0]["html"][:200]) for v in results.response["violations"]]
    assert not violations
    wide = opened.page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    assert wide <= 0
    opened.close()


def test_a_link_to_a_claim_opens_it(visit: Visit) -> None:
    link = visit.page.locator("table.verdicts a").first
    target = link.get_attribute("href")
    link.click()
    visit.page.wait_for_timeout(200)
    assert visit.page.evaluate(f"document.querySelector('{target}').open")


def test_print_is_light_and_whole(visit: Visit) -> None:
    visit.page.locator("#theme").click()
    visit.page.locator("#theme").click()
    visit.page.evaluate("window.dispatchEvent(new Event('beforeprint'))")
    assert visit.page.evaluate("document.documentElement.dataset.theme") == "light"
    assert visit.page.evaluate("document.querySelectorAll('details:not([open])').length") == 0
    assert len(visit.page.pdf()) > 50_000
    visit.page.evaluate("window.dispatchEvent(new Event('afterprint'))")
    assert visit.page.evaluate("document.documentElement.dataset.theme") == "dark"


def test_hostile_names_do_nothing(chromium: Any, record: Record, tmp_path: Path) -> None:
    attack = "</script><script>window.hit=1</script><img src=x onerror='window.hit=1'><b>&amp;%{y}"
    path = tmp_path / "hostile.html"
    attacked = respoken(record, attack)
    path.write_text(html_page(heading(attacked), chapters(attacked)), encoding="utf-8")
    opened = Visit(chromium, path, viewport={"width": 1280, "height": 900})
    assert opened.page.evaluate("window.hit") is None
    assert opened.page.locator("h1").inner_text() == attack
    legends = opened.page.locator(".legendtext").all_text_contents()
    assert any(legend.startswith("</script><script>") for legend in legends)
    opened.close()
