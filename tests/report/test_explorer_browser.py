"""The explorer's page in a real browser, without a network: what is drawn is what is stored."""

import re
import shutil

import numpy as np
import pytest
from stubs import explorer_stub as stub
from stubs.unpacked_period import unpacked

from microslip.report.explorer.explorer import MAPS
from microslip.report.explorer.page import write
from microslip.sweeps.store import Store

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed: apt install chromium"),
]
FLAGS = ["--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"]
FLAGS += ["--disable-component-update", "--disable-sync"]


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    """The page's path, and the datasets and periods that it was made from."""
    folder = tmp_path_factory.mktemp("explorer")
    datasets, records = stub.computed(folder, Store(folder))
    write(folder / "explorer.html", datasets, records)
    return folder / "explorer.html", datasets, records


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    reason = "playwright is not installed: pip install -e '.[dev]'"
    api = pytest.importorskip("playwright.sync_api", reason=reason)
    with api.sync_playwright() as playwright:
        context = playwright.chromium.launch_persistent_context(
            tmp_path_factory.mktemp("profile"),
            executable_path=CHROMIUM,
            args=FLAGS,
            viewport={"width": 1280, "height": 800},
        )
        context.set_offline(True)
        yield context
        context.close()


@pytest.fixture(scope="module")
def opened(made, browser):
    """The page, opened once, with what it says to the console and what it asks for."""
    page, heard, asked = browser.new_page(), [], []
    page.on("console", lambda message: heard.append(message.text))
    page.on("pageerror", lambda error: heard.append(str(error)))
    page.on("request", lambda request: asked.append(request.url))
    page.goto(made[0].as_uri())
    page.locator("body[data-ready]").wait_for()
    return page, heard, asked


@pytest.fixture
def page(made, opened):
    """The page as the test before has left it. It has to say nothing, and to ask for nothing."""
    page, heard, asked = opened
    page.set_viewport_size({"width": 1280, "height": 800})
    yield page
    assert heard == []
    assert asked == [made[0].as_uri()]


def click_on_map(page, velocity, amplitude):
    """Press the mouse on a point of the map, by the coordinates of the screen."""
    x, y = page.evaluate(
        """([velocity, amplitude]) => {
          const chart = element("map"), box = chart.getBoundingClientRect();
          const { xaxis, yaxis } = chart._fullLayout;
          return [box.left + xaxis._offset + xaxis.l2p(Math.log10(velocity)),
                  box.top + yaxis._offset + yaxis.l2p(amplitude)];
        }""",
        [velocity, amplitude],
    )
    page.mouse.move(x - 3, y - 3)
    page.mouse.move(x, y)
    page.locator("#map .hovertext").wait_for()
    assert f"velocity {velocity:g}, amplitude {amplitude:g}" in page.text_content("#map .hovertext")
    page.mouse.click(x, y)
    page.wait_for_timeout(100)


def drawn_line(page, chart, trace):
    """Points of a line as it stands on the screen, in the units of its axes: x, y."""
    path, sizes = page.evaluate(
        """([id, trace]) => {
          const chart = element(id), { xaxis, yaxis } = chart._fullLayout;
          const uid = chart._fullData[trace].uid;
          const line = chart.querySelector(`.trace${uid} .js-line`).getAttribute("d");
          return [line, [xaxis.range, xaxis._length, yaxis.range, yaxis._length]];
        }""",
        [chart, trace],
    )
    assert set(re.findall("[A-Za-z]", path)) <= set("MLHV")
    x, y = [], []
    for command, numbers in re.findall("([MLHV])([^MLHV]*)", path):
        values = [float(n) for n in re.findall(r"-?[\d.]+(?:e-?\d+)?", numbers)]
        if command == "V":
            values = [x[-1], values[0]]
        if command == "H":
            values = [values[0], y[-1]]
        x += values[0::2]
        y += values[1::2]
    (left, right), width, (low, high), height = sizes
    x, y = np.array(x) / width, 1 - np.array(y) / height
    return left + (right - left) * x, low + (high - low) * y


def select(page, name):
    page.get_by_role("button", name=re.compile(name, re.I)).click()


def record_at(records, name, velocity, amplitude):
    wanted = f"{amplitude:g}", f"{velocity:g}"
    (record,) = (record for record in records[name] if stub.place(record) == wanted)
    return record["result"]


PLACES = [("transverse", 0.02, 0.6), ("transverse", 0.1, 1.2), ("bore", 0.1, 0.6), ("bore", 1, 1.2)]


@pytest.mark.long
@pytest.mark.parametrize(("name", "velocity", "amplitude"), PLACES)
def test_a_click_shows_the_points_value_and_its_loop(made, page, name, velocity, amplitude):
    _, datasets, records = made
    select(page, name)
    click_on_map(page, velocity, amplitude)
    point = datasets[name].sel(velocity=velocity, amplitude=amplitude)
    mu, error = float(point.mu_macro), float(point.mu_macro_error)
    shown = re.search(r"mu_macro (-?[\d.]+) ± ([\d.e-]+)", page.inner_text("#value"))
    assert float(shown[1]) == pytest.approx(mu, abs=5.1e-6)
    assert float(shown[2]) == pytest.approx(error, rel=0.06)
    assert f"velocity {velocity:g}, amplitude {amplitude:g}" in page.inner_text("#certificate")
    # the lines on the screen: the certified mean, and the force, whose mean that is
    pixel = 1.2 / page.evaluate("element('history')._fullLayout.yaxis._length")
    assert drawn_line(page, "history", 2)[1] == pytest.approx(mu, abs=pixel)
    phase, force = drawn_line(page, "history", 3)
    result = record_at(records, name, velocity, amplitude)
    mean = stub.mean_over(phase, force)
    assert mean == pytest.approx(result["mu_macro"], abs=pixel)
    assert mean == pytest.approx(mu, abs=pixel + error + 0.01)  # a coarse run's own error
    other, force = drawn_line(page, "loop", 1)
    wanted = {"transverse": "force_lateral", "bore": "torque"}[name]
    assert other.max() == pytest.approx(max(result[wanted]), abs=0.02)
    assert force.min() == pytest.approx(min(result["force_forward"]), abs=pixel)


@pytest.mark.parametrize("name", MAPS)
def test_every_frame_of_the_contact_is_the_stored_one(made, page, name):
    select(page, name)
    click_on_map(page, 0.02, 0.6)
    truth = unpacked(record_at(made[2], name, 0.02, 0.6))
    frames = len(truth["phase"])
    angle = np.array(page.evaluate("sectorAngles(STATE.map)"))
    radius = np.array(page.evaluate("STATE.period.radius"))
    lateral = np.outer(np.cos(angle), radius).ravel()
    assert lateral == pytest.approx(truth["lateral_position"], abs=2e-5)
    for frame in range(frames):
        cells = page.evaluate("(frame) => cellsOf(STATE.period, frame)", frame)
        at = frame % (frames - 1)
        # the frame half a period on is drawn as the mirror image of the first
        off = 2e-2 if at == frames // 2 else 1e-9
        for way in ("forward", "lateral"):
            share = truth[f"traction_{way}"][at] / truth["bound"]
            assert cells[way] == pytest.approx(share, abs=off), (frame, way)
        assert np.mean(cells["slips"] != truth["slips"][at]) < off, frame


def test_the_phase_slider_and_the_animation_move_the_contact(made, page):
    select(page, "bore")
    click_on_map(page, 0.02, 0.6)
    truth = unpacked(record_at(made[2], "bore", 0.02, 0.6))
    drawn = "(k) => element('disc').data[k].x.filter((x) => x === null).length"
    page.locator("#phase").press("Home")
    for frame in range(1, 9):
        page.keyboard.press("ArrowRight")
        slipping = truth["slips"][frame].sum()
        assert page.evaluate(drawn, 1) == slipping
        assert page.evaluate(drawn, 0) == truth["slips"][frame].size - slipping
    phase = float(page.inner_text("#phase-value").rstrip("°"))
    assert phase == pytest.approx(np.degrees(truth["phase"][8]), abs=0.6)
    before = page.evaluate("STATE.frame")
    page.get_by_role("button", name="Play").click()
    for _ in range(100):
        page.wait_for_timeout(50)
        if page.evaluate("STATE.frame") not in (before, before + 1):
            break
    page.get_by_role("button", name="Pause").click()
    at = page.evaluate("STATE.frame")
    assert at != before
    assert page.evaluate(drawn, 1) == truth["slips"][at % 32].sum()
    page.wait_for_timeout(200)
    assert page.evaluate("STATE.frame") == at


def test_sliders_reach_every_point_by_keyboard_and_boxes_switch_limits(made, page):
    dataset = made[1]["transverse"]
    select(page, "transverse")
    for slider, dim in (("amplitude", "amplitude"), ("velocity", "velocity")):
        page.locator(f"#{slider}").focus()
        page.keyboard.press("Home")
        for value in dataset[dim].values:
            assert float(page.inner_text(f"#{slider}-value")) == pytest.approx(value, rel=1e-3)
            page.keyboard.press("ArrowRight")
    assert "velocity 1, amplitude 1.2" in page.inner_text("#certificate")
    # the cuts go through the selected point
    for chart, cut in (
        ("along-velocity", dataset.sel(amplitude=1.2)[{"velocity": slice(1, None)}]),
        ("along-amplitude", dataset.sel(velocity=1)),
    ):
        shown = page.evaluate("(id) => element(id).data.at(-1).y", chart)
        assert shown == pytest.approx(cut.mu_macro.values, abs=1e-12)
        lines = page.evaluate("(id) => element(id).data.slice(0, -1).map((t) => t.x.length)", chart)
        assert len(lines) == 4
        assert min(lines) >= 2  # level lines too
    box = page.get_by_label("Eq 7")
    visible = "element('along-amplitude').data.find((t) => t.name.startsWith('Eq 7')).visible"
    assert page.evaluate(visible) is True
    box.uncheck()
    assert page.evaluate(visible) is False
    page.locator("#amplitude").press("ArrowLeft")
    assert page.evaluate(visible) is False
    box.check()
    assert page.evaluate(visible) is True


def test_what_did_not_converge_says_so(page):
    select(page, "transverse")
    click_on_map(page, 1, 0.6)
    assert "not converged: made up" in page.inner_text("#certificate")
    assert "not converged (1 of 9)" in page.inner_text("#map")
    click_on_map(page, 1, 1.2)
    said = page.inner_text("#run")
    assert said.startswith("No period was found: none to be found Drawn below: the nearest point")
    assert said.endswith("at velocity 1, amplitude 0.6.")
    assert page.locator("#disc").is_visible()  # of the nearest point that has a period
    page.locator("#velocity").press("Home")
    assert "static limit" in page.inner_text("#run")
    page.locator("#amplitude").press("Home")
    assert "Nothing oscillates here" in page.inner_text("#run")
    select(page, "bore")
    click_on_map(page, 0.02, 1.2)
    assert "It did not converge: none to be found" in page.inner_text("#run")
    assert page.locator("#disc").is_visible()


def test_it_tells_what_made_it_and_fits_the_screen(made, page):
    page.get_by_text("What made this page").click()
    text = page.inner_text("#made")
    for dataset in made[1].values():
        for key in ("title", "microslip_version", "source_digest"):
            assert dataset.attrs[key] in text
    assert '"amplitude"' in text
    page.get_by_text("What made this page").click()
    width, height = page.evaluate(
        "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
    )
    assert (width, height) == (1280, 800)


# On a phone


@pytest.fixture
def phone(made, browser):
    """The page on a small screen."""
    page = browser.new_page()
    page.set_viewport_size({"width": 400, "height": 800})
    page.goto(made[0].as_uri())
    page.locator("body[data-ready]").wait_for()
    yield page
    page.close()


CHARTS = ("map", "along-velocity", "along-amplitude", "disc", "history", "loop")
BOXES = """(selector) => [...document.querySelectorAll(selector)].map((found) => {
  const { left, right, top, bottom } = found.getBoundingClientRect();
  return [left, right, top, bottom];
})"""


def test_a_phone_shows_one_column_and_scrolls_in_one_direction(phone):
    width = "document.documentElement.scrollWidth"
    assert phone.evaluate(width) <= 400
    phone.get_by_text("What made this page").click()
    assert phone.evaluate(width) <= 400
    boxes = phone.evaluate(BOXES, ".plot")
    assert len(boxes) == len(CHARTS)
    for left, right, *_ in boxes:
        assert 0 <= left < 20 and 380 < right <= 400
    bottoms = [bottom for *_, bottom in boxes[:-1]]
    tops = [top for _, _, top, _ in boxes[1:]]
    assert all(bottom <= top for bottom, top in zip(bottoms, tops, strict=True))
    # labels of axes are on the screen, too
    for left, right, *_ in phone.evaluate(BOXES, ".plot .infolayer text"):
        assert left >= -0.5 and right <= 400.5


def test_a_finger_finds_every_control_of_the_phone(phone):
    selectors = ("button", "input[type=range]", "#limits label", "summary")
    for selector in selectors:
        boxes = [box for box in phone.evaluate(BOXES, selector) if box[1] > box[0]]
        assert boxes
        for left, right, top, bottom in boxes:
            assert bottom - top >= 44 and right - left >= 44, selector
    size = "(id) => parseFloat(getComputedStyle(document.querySelector(id)).fontSize)"
    assert all(phone.evaluate(size, id) >= 16 for id in ("button", "#value", "#limits label"))


@pytest.mark.long
def test_a_finger_scrolls_the_phone_and_zooms_no_chart(phone):
    for chart in CHARTS:
        axes = "(id) => { const l = element(id)._fullLayout; return [l.xaxis, l.yaxis, l.dragmode]"
        fixed = phone.evaluate(axes + ".map((a) => a && a.fixedrange)}", chart)
        assert fixed[:2] == [True, True]
        assert phone.evaluate("(id) => element(id)._fullLayout.dragmode", chart) is False
    assert not phone.locator(".modebar-btn").count()
    click_on_map(phone, 0.1, 1.2)  # a tap still chooses a point
    assert "velocity 0.1, amplitude 1.2" in phone.inner_text("#certificate")


@pytest.mark.long
def test_the_form_opens_in_view_and_fits_a_phone(phone):
    phone.set_viewport_size({"width": 375, "height": 700})
    phone.get_by_role("button", name="A real contact").click()
    phone.wait_for_timeout(200)
    ((left, right, top, _),) = phone.evaluate(BOXES, "#contact-form")
    assert 0 <= left < right <= 375
    assert -2 <= top < 350
    assert phone.locator("#contact-value").inner_text().startswith("No certified friction")
    assert phone.evaluate("document.documentElement.scrollWidth") <= 375
    for selector in (".field input", ".field select", "#ask"):
        boxes = [box for box in phone.evaluate(BOXES, selector) if box[1] > box[0]]
        assert boxes
        for left, right, top, bottom in boxes:
            assert bottom - top >= 44 and left >= 0 and right <= 375, selector


@pytest.mark.long
def test_turning_the_phone_lays_it_out_again(phone):
    phone.set_viewport_size({"width": 1000, "height": 600})
    phone.wait_for_timeout(300)
    assert phone.evaluate("document.documentElement.scrollWidth") <= 1000
    assert phone.evaluate("element('along-velocity')._fullLayout.dragmode") == "zoom"


@pytest.mark.slow
@pytest.mark.parametrize("width", [800, 1280])
def test_buttons_of_the_charts_cover_no_data(page, width):
    page.set_viewport_size({"width": width, "height": 800})
    page.wait_for_timeout(300)
    for chart in CHARTS:
        page.locator(f"#{chart}").hover()
        (bar,) = page.evaluate(BOXES, f"#{chart} .modebar-group")
        (area,) = page.evaluate(BOXES, f"#{chart} .bglayer .bg, #{chart} .nsewdrag")[:1]
        assert bar[3] <= area[2], chart  # it ends above the area of the data
        for _left, right, top, bottom in page.evaluate(BOXES, f"#{chart} .legendtext"):
            assert right <= bar[0] or bottom <= bar[2] or top >= bar[3], chart
