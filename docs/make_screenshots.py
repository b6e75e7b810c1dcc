"""Take the screenshots of the studio's views, at desktop and phone size: `make figures`."""

from __future__ import annotations

import contextlib
import io
import itertools
import re
import shutil
import socket
import subprocess
import sys
import tempfile
from pathlib import Path

from PIL import Image
from playwright.sync_api import Browser, Page, ViewportSize, sync_playwright

from tarsus import load_robot
from tarsus.hardware import nominal_calibration
from tarsus.hardware.calibration.file import calibration_text
from tarsus.studio.machine.calibration import CalibrationText
from tarsus.studio.machine.hardware import Hardware
from tarsus.studio.messages.physics import PhysicsOptions, TerrainChoice
from tarsus.studio.messages.state import BodyState, Curve, JointsState, Picture, SourceChoice, StudioState, WalkOptions
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Settings
from tarsus.studio.state_text import text_of

FIGURES = Path(__file__).parent / "figures"
SIZES = {"desktop": ViewportSize(width=1280, height=800), "phone": ViewportSize(width=390, height=844)}
FLAGS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--no-sandbox")

_UP, _DOWN = (0.0, 85.0, -100.0), (0.0, 34.6, -100.7)
_LIFTED = _UP + _DOWN * 3 + (10.0, 70.0, -127.0) + _DOWN
_CURVE = WalkOptions(gait="ripple", path=Curve(kind="curve", angle_deg=70.0, centre_mm=(0.0, 500.0)))
STATES = (
    StudioState(view="joints", joints=JointsState(angles_deg=_LIFTED)),
    StudioState(view="body", body=BodyState(x_mm=15.0, y_mm=-140.0, z_mm=-35.0, roll_deg=-6.0), picture=Picture(leg=1)),
    StudioState(view="walk", walk=_CURVE, picture=Picture(time_s=2.6)),
    StudioState(view="drive", picture=Picture(camera="follow")),
    StudioState(view="loads", picture=Picture(time_s=1.4)),
    StudioState(view="robot"),
    StudioState(view="sources", source=SourceChoice(number="000", leg=1), body=BodyState(x_mm=20.0, yaw_deg=8.0)),
)
# The walk in physics, which has one picture.
_BLOCKS = PhysicsOptions(on=True, terrain=TerrainChoice(kind="blocks", values={"rise": 25.0, "clear": 250.0}))
PHYSICS = StudioState(view="walk", physics=_BLOCKS, picture=Picture(time_s=2.4))
READY = {"walk": "walk-facts", "drive": "drive-facts", "loads": "torques", "robot": "robot-facts", "sources": "source"}


def drive(page: Page) -> None:
    """Walk on a curve."""
    page.locator("main h2").click()
    for key in "wq":
        page.keyboard.down(key)
    page.wait_for_timeout(3500)


def take(browser: Browser, url: str, state: StudioState, name: str) -> Path:
    """Take the screenshot of a view at one size."""
    phone = name == "phone"
    context = browser.new_context(
        viewport=SIZES[name], reduced_motion="reduce", color_scheme="light", has_touch=phone, is_mobile=phone
    )
    page = context.new_page()
    page.goto(f"{url}#s={text_of(state)}")
    ready = "simulated-facts" if state.physics.on else READY.get(state.view, "standing-facts")
    page.get_by_test_id(ready).wait_for()
    if state.view == "drive":
        drive(page)
    page.wait_for_timeout(1500)
    path = save(page, f"{'physics' if state.physics.on else state.view}-{name}")
    context.close()
    return path


def bring_up(browser: Browser) -> Path:
    """Take the screenshot of a question of the bring-up, with emulated servos."""
    with (
        tempfile.TemporaryDirectory() as folder,
        contextlib.chdir(folder),
        Serving(Settings(hardware=Hardware(Path()))) as server,
    ):
        page = browser.new_page(viewport=SIZES["desktop"], reduced_motion="reduce", color_scheme="light")
        page.goto(f"{server.url}#s={text_of(StudioState(view='robot'))}")
        page.get_by_text("Bring-up of the servos").click()
        page.get_by_test_id("bring-up").click()
        for name in ("Feetech STS", "emulated servos", "front left"):
            page.locator(".choices").get_by_role("button", name=re.compile(f"^{name}")).click()
        page.get_by_test_id("choice-f").wait_for()
        page.wait_for_timeout(1000)
        path = save(page, "bring-up-desktop")
        page.get_by_test_id("bring-up-leave").click()
        page.get_by_test_id("bring-up-end").wait_for()
        page.close()
    return path


def pulses(browser: Browser) -> Path:
    """Take the screenshot of pulses beside joint angles."""
    calibration = nominal_calibration(load_robot("strider"), "strider", kind="servo2040")
    text = CalibrationText("strider.calibration.toml", calibration_text(calibration))
    state = StudioState(view="joints", joints=JointsState(angles_deg=_LIFTED))
    with Serving(Settings(calibration=text)) as server:
        page = browser.new_page(viewport=SIZES["desktop"], reduced_motion="reduce", color_scheme="light")
        page.goto(f"{server.url}#s={text_of(state)}")
        page.get_by_test_id("standing-facts").wait_for()
        page.get_by_test_id("copy-pulses").wait_for(state="attached")
        unfold(page)
        page.get_by_test_id("copy-pulses").scroll_into_view_if_needed()
        page.wait_for_timeout(1500)
        path = save(page, "pulses-desktop")
        page.close()
    return path


def run_view(browser: Browser) -> Path:
    """Take the screenshot of the view that drives a machine, with emulated servos."""
    # Drawing in software takes most of a computer; a low rate leaves the ticks their time.
    options = ["run", "strider", "--bus", "emulated", "--rate", "25"]
    command = [sys.executable, "-c", "from tarsus.cli import main; main()", *options]
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{free.getsockname()[1]}"
    with subprocess.Popen([*command, "--studio", address], stderr=subprocess.PIPE, text=True) as run:
        assert run.stderr is not None
        line = next(each for each in run.stderr if "http" in each)
        page = browser.new_page(viewport=SIZES["desktop"], reduced_motion="reduce", color_scheme="light")
        page.goto(line.split()[-1])
        page.get_by_test_id("machine-facts").wait_for()
        drive(page)
        path = save(page, "run-desktop")
        page.get_by_test_id("end-run").click()
        run.wait(timeout=60)
        page.close()
    return path


def unfold(page: Page) -> None:
    """Open all parts of a panel."""
    for summary in page.locator("details:not([open]) > summary").all():
        if summary.is_visible():
            summary.click()


def save(page: Page, name: str) -> Path:
    """Save what a page shows as a figure."""
    picture = Image.open(io.BytesIO(page.screenshot())).convert("RGB")
    path = FIGURES / f"studio-{name}.png"
    # 256 colours are sufficient and keep the file small.
    picture.quantize(256, method=Image.Quantize.MAXCOVERAGE, kmeans=4, dither=Image.Dither.NONE).save(
        path, optimize=True
    )
    return path


def main() -> None:
    """Take all screenshots."""
    chromium = shutil.which("chromium")
    with Serving(Settings()) as server, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=chromium, args=list(FLAGS))
        for state, name in [*itertools.product(STATES, SIZES), (PHYSICS, "desktop")]:
            path = take(browser, server.url, state, name)
            print(f"{path.name}: {path.stat().st_size // 1000} kB")
        for picture in (bring_up, pulses, run_view):
            path = picture(browser)
            print(f"{path.name}: {path.stat().st_size // 1000} kB")
        browser.close()


if __name__ == "__main__":
    main()
