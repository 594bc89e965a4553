"""The assembly in 3-D: turned, hidden, taken apart, cut, put together, picked, moved, coloured."""

import base64
import io
from collections.abc import Iterator
from typing import Any

import pytest
from opened_page import Opened
from PIL import Image
from sample_pages import LEG_MOVED, RING
from support import wait_until

pytestmark = pytest.mark.gate
VIEWER = "document.getElementById('figure-solids').viewer"


class Solids:
    """The figure with what its parts are like."""

    def __init__(self, view: Opened) -> None:
        self.view = view
        self.figure = view.figure("solids")
        view.page.wait_for_selector("html[data-ready=all]")  # the steps' pictures are taken of it, too

    def part(self, name: str, what: str) -> Any:
        """Return an expression of a part."""
        return self.view.page.evaluate(f"{VIEWER}.parts.get('{name}').{what}")

    def picture(self) -> str:
        """Return what the canvas shows now."""
        return str(self.view.page.evaluate(f"({VIEWER}.stage.drawNow(), {VIEWER}.stage.canvas.toDataURL())"))

    def slide(self, name: str, value: float) -> None:
        self.figure.get_by_role("slider", name=name, exact=True).fill(str(value))


@pytest.fixture
def solids(screen: Opened) -> Iterator[Solids]:
    """Show the assembly; restore every control afterwards."""
    shown = Solids(screen)
    yield shown
    for name, value in (("Apart", 0), ("Rotor", 0), ("Assembly step", 3)):
        shown.slide(name, value)
    shown.figure.get_by_role("combobox", name="View").select_option("top")
    shown.figure.get_by_role("combobox", name="View").select_option("corner")


def test_parts_are_hidden_taken_apart_and_turned(solids):
    before = solids.picture()
    box = solids.figure.get_by_role("checkbox", name="housing", exact=True)
    box.uncheck()
    assert solids.part("housing", "object.visible") is False
    assert solids.picture() != before
    box.check()
    assert solids.picture() == before
    at = "object.matrix.elements[14]"
    before = {name: solids.part(name, at) for name in ("housing", "rotor")}
    solids.slide("Apart", 0.5)
    assert solids.part("housing", at) == pytest.approx(before["housing"])
    assert solids.part("rotor", at) == pytest.approx(before["rotor"] + 0.5 * 90.0)


@pytest.mark.parametrize(("view", "apart"), [("corner", 0), ("corner", 1), ("top", 0), ("front", 0)])
def test_the_module_fills_its_picture_and_is_whole_in_it(solids, view, apart):
    solids.slide("Apart", apart)
    solids.figure.get_by_role("combobox", name="View").select_option("below")
    solids.figure.get_by_role("combobox", name="View").select_option(view)
    data = base64.b64decode(solids.picture().partition(",")[2])
    with Image.open(io.BytesIO(data)) as picture:
        width, height = picture.size
        box = picture.getchannel("A").getbbox()
    assert box
    left, top, right, bottom = box
    assert min(left, top, width - right, height - bottom) > 0
    assert max((right - left) / width, (bottom - top) / height) > 0.8


def test_parts_are_cut_picked_and_turned_by_keys(solids):
    before = solids.picture()
    solids.figure.get_by_role("combobox", name="Cut").select_option("y")
    assert solids.part("housing", "outside.clippingPlanes.length") == 1
    assert solids.picture() != before
    solids.figure.get_by_role("combobox", name="Cut").select_option("none")
    assert solids.picture() == before
    solids.figure.locator("canvas").click()
    about = solids.figure.locator(".about")
    assert about.get_by_role("heading").inner_text() in {"housing", "rotor", "link"}
    button = solids.figure.get_by_role("button", name="about pcl arc")
    button.focus()
    solids.view.page.keyboard.press("Enter")
    assert "material of pcl_arc_1" in about.inner_text()
    assert about.get_by_role("link").get_attribute("href") == "cad/step/pcl_arc_1.step"
    before = solids.picture()
    solids.figure.locator("canvas").focus()
    solids.view.page.keyboard.press("ArrowLeft")
    assert solids.picture() != before
    solids.view.page.keyboard.press("ArrowRight")
    position = solids.view.page.evaluate(f"{VIEWER}.stage.camera.position.toArray()")
    assert len(position) == 3


def test_the_rotor_turns_and_winds_the_spring(solids):
    vertex = f"geometry.getAttribute('position').getY({2 * RING})"
    resting, held = solids.part("spring_right_1", vertex), "geometry.getAttribute('position').getY(0)"
    tang = solids.part("spring_right_1", held)
    solids.slide("Rotor", 1)
    assert solids.part("rotor", "object.matrix.elements[1]") == pytest.approx(0.0998, abs=1e-4)  # sin(0.1)
    assert solids.part("housing", "object.matrix.elements[1]") == 0.0
    assert solids.part("spring_right_1", vertex) == pytest.approx(resting + LEG_MOVED, abs=1e-4)
    assert solids.part("spring_right_1", held) == tang
    solids.slide("Rotor", -0.76)
    assert solids.part("spring_right_1", vertex) == pytest.approx(resting - 0.76 * LEG_MOVED, abs=1e-4)


def test_the_layer_has_the_colour_of_its_temperature(solids):
    solids.figure.get_by_role("checkbox", name="Layer by its temperature").check()
    painted = f"{VIEWER}.parts.get('pcl_arc_1').geometry.getAttribute('color')"
    colours = f"Array.from({painted}.array)"
    cold = solids.view.page.evaluate(colours)
    assert max(cold[0::3]) < min(cold[2::3])  # blue at the start
    solids.view.page.evaluate("import('page/time.js').then(({ moveTo }) => moveTo(60))")
    assert wait_until(lambda: max(solids.view.page.evaluate(colours)[0::3]) > max(cold[0::3]))


def test_the_assembly_is_put_together_step_by_step_with_pictures(solids):
    solids.slide("Assembly step", 2)
    assert "Lay the pad and the arc into it." in solids.figure.inner_text()
    assert solids.part("rotor", "object.visible") is False
    assert solids.part("pcl_arc_1", "object.visible") is True
    pictures = solids.view.page.locator("#steps .steps img")
    assert pictures.count() == 3
    assert len({pictures.nth(i).get_attribute("src") for i in range(3)}) == 3
    solids.view.page.get_by_role("heading", name="Assembly steps").click()
    solids.view.page.get_by_role("button", name="Show in 3-D").last.click()
    assert solids.part("rotor", "object.visible") is True
