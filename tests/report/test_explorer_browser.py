"""The explorer's page in a real browser without a network: layout and gestures."""

import shutil
from itertools import pairwise

import pytest
from stubs import explorer_stub as stub

from microslip.report.explorer.page import build
from microslip.report.explorer.page import page as page_of
from microslip.report.motions import MOTIONS

CHROMIUM = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
pytestmark = [
    pytest.mark.slow,
    pytest.mark.skipif(CHROMIUM is None, reason="Chromium is not installed: apt install chromium"),
]
FLAGS = ["--disable-gpu", "--disable-quic", "--no-first-run", "--disable-background-networking"]
FLAGS += ["--disable-component-update", "--disable-sync"]


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    reason = "playwright is not installed: pip install -e '.[dev]'"
    api = pytest.importorskip("playwright.sync_api", reason=reason)
    with api.sync_playwright() as playwright:
        profile = tmp_path_factory.mktemp("profile")
        options = {"executable_path": CHROMIUM, "args": FLAGS}
        context = playwright.chromium.launch_persistent_context(profile, **options)
        context.set_offline(True)
        yield context
        context.close()


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Address of the page."""
    path = tmp_path_factory.mktemp("explorer") / "explorer.html"
    path.write_text(page_of(build(*stub.made_up(path.parent))), encoding="utf-8")
    return path.as_uri()


@pytest.fixture
def page(address, browser):
    """The open page. A test must cause no console message and no network request."""
    page, messages, requests = browser.new_page(), [], []
    page.on("console", lambda message: messages.append(message.text))
    page.on("pageerror", lambda error: messages.append(str(error)))
    page.on("request", lambda request: requests.append(request.url))
    page.set_viewport_size({"width": 1280, "height": 800})
    page.goto(address)
    page.locator("body[data-ready]").wait_for()
    yield page
    page.close()
    assert messages == [] and set(requests) == {address}


def click_on_map(page, velocity, amplitude):
    """Click on a point of the map."""
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


@pytest.mark.long
def test_a_click_selects_a_point_and_the_page_fits_the_screen(page):
    for name in MOTIONS:
        page.locator("#sweeps").select_option(name)
        click_on_map(page, 0.1, 0.6)
        assert "velocity 0.1, amplitude 0.6" in page.inner_text("#certificate")
        assert page.locator("#disc").is_visible()
    size = "[document.documentElement.scrollWidth, document.documentElement.scrollHeight]"
    assert page.evaluate(size) == [1280, 800]


def test_sliders_move_by_keyboard_and_the_animation_plays(page):
    page.locator("#sweeps").select_option("transverse")
    page.locator("#velocity").focus()
    page.keyboard.press("Home")
    for value in ("0", "0.02", "0.1"):
        assert page.inner_text("#velocity-value") == value
        page.keyboard.press("ArrowRight")
    page.locator("#velocity").press("ArrowLeft")
    before = page.evaluate("STATE.frame")
    page.get_by_role("button", name="Play").click()
    for _ in range(100):  # the page forbids code in texts, which wait_for_function needs
        if page.evaluate("STATE.frame") != before:
            break
        page.wait_for_timeout(100)
    assert page.evaluate("STATE.frame") != before
    page.get_by_role("button", name="Pause").click()
    frame = page.evaluate("STATE.frame")
    page.wait_for_timeout(200)
    assert page.evaluate("STATE.frame") == frame


# On a phone


@pytest.fixture
def phone(page):
    """The page on a screen of 400 x 800 pixels."""
    page.set_viewport_size({"width": 400, "height": 800})
    page.reload()
    page.locator("body[data-ready]").wait_for()
    return page


CHARTS = ("map", "along-velocity", "along-amplitude", "disc", "history", "loop")
BOXES = """(selector) => [...document.querySelectorAll(selector)].map((found) => {
  const { left, right, top, bottom } = found.getBoundingClientRect();
  return [left, right, top, bottom];
})"""


@pytest.mark.long
def test_a_phone_shows_one_column_that_a_finger_scrolls(phone):
    click_on_map(phone, 0.1, 1.2)  # a tap selects a point
    assert "velocity 0.1, amplitude 1.2" in phone.inner_text("#certificate")
    width = "document.documentElement.scrollWidth"
    assert phone.evaluate(width) <= 400
    phone.get_by_text("What made this page").click()
    assert phone.evaluate(width) <= 400
    boxes = phone.evaluate(BOXES, ".plot")
    assert len(boxes) == len(CHARTS)
    for (*_, bottom), (_, _, top, _) in pairwise(boxes):
        assert bottom <= top
    for left, right, *_ in boxes:
        assert 0 <= left < 20 and 380 < right <= 400
    # labels of axes are on the screen
    for left, right, *_ in phone.evaluate(BOXES, ".plot .infolayer text"):
        assert left >= -0.5 and right <= 400.5
    for chart in CHARTS:  # cannot be zoomed
        layout = "const l = element(id)._fullLayout; return [l.xaxis, l.yaxis, l.dragmode]"
        code = f"(id) => {{ {layout}.map((a) => a && a.fixedrange).concat(l.dragmode) }}"
        assert phone.evaluate(code, chart) == [True, True, False, False]
    assert not phone.locator(".modebar-btn").count()


@pytest.mark.long
def test_the_form_opens_in_view_and_fits_a_phone(phone):
    phone.set_viewport_size({"width": 375, "height": 700})
    phone.get_by_role("button", name="A real contact").click()
    phone.wait_for_timeout(200)
    ((left, right, top, _),) = phone.evaluate(BOXES, "#contact-form")
    assert 0 <= left < right <= 375 and -2 <= top < 350
    assert phone.locator("#contact-value").inner_text().startswith("The page has no certified map")
    assert phone.evaluate("document.documentElement.scrollWidth") <= 375
    boxes = phone.evaluate(BOXES, ".field input, .field select, #ask")
    boxes = [box for box in boxes if box[1] > box[0]]
    assert len(boxes) > 10
    for left, right, top, bottom in boxes:
        assert bottom - top >= 44 and left >= 0 and right <= 375
