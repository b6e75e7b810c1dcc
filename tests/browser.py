"""What the end-to-end tests share: the system's Chromium, and visitors whose page must stay in order."""

from __future__ import annotations

import re
import shutil
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from urllib.parse import urlsplit

from playwright.sync_api import Browser, BrowserContext, Locator, Page, expect

from tarsus.studio.messages.state import StudioState
from tarsus.studio.server.serve import Serving
from tarsus.studio.state_text import text_of

AXE = Path(__file__).parents[1] / "web" / "node_modules" / "axe-core" / "axe.min.js"
VIEWS = ("joints", "body", "walk", "drive", "loads", "robot", "sources")
PHONE = {"width": 390, "height": 844}
# Small: every pixel is drawn without a graphics card.
DESK = {"width": 900, "height": 560}
FLAGS = ("--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--ignore-gpu-blocklist", "--no-sandbox")
# Cores are shared with other tests: a page may be slow, and is still right.
PATIENCE = 30_000

expect.set_options(timeout=PATIENCE)


def launch(playwright: Any) -> Browser:
    """Start the system's Chromium, drawing 3D without a graphics card."""
    path = shutil.which("chromium")
    assert path is not None, "there is no command chromium; `make browser` installs it"
    return playwright.chromium.launch(executable_path=path, args=list(FLAGS))


@dataclass
class Visitor:
    """A page of the studio, and all that it asked for and complained of."""

    server: Serving
    context: BrowserContext
    page: Page
    requests: list[str] = field(default_factory=list)
    complaints: list[str] = field(default_factory=list)

    @classmethod
    def of(cls, server: Serving, context: BrowserContext) -> Visitor:
        context.set_default_timeout(PATIENCE)
        self = cls(server, context, context.new_page())
        context.on("request", lambda request: self.requests.append(request.url))
        self.page.on("websocket", lambda socket: self.requests.append(socket.url))
        self.page.on("console", lambda said: said.type in ("error", "warning") and self.complaints.append(said.text))
        self.page.on("pageerror", lambda error: self.complaints.append(str(error)))
        return self

    def open(self, state: StudioState | None = None, *, url: str | None = None) -> Visitor:
        """Open the studio, in a state where one is given, and wait until it shows the robot."""
        address = url or self.server.url + ("" if state is None else f"#s={text_of(state)}")
        self.page.goto(address)
        self.at("panel-ready").wait_for()
        return self

    def at(self, name: str) -> Locator:
        """Find an element by its test id."""
        if name == "panel-ready":
            return self.page.locator("main h2")
        return self.page.get_by_test_id(name)

    def view(self, view: str) -> None:
        """Go to a view."""
        self.at(f"tab-{view}").click()
        expect(self.at(f"tab-{view}")).to_have_attribute("aria-selected", "true")

    def type(self, name: str, number: float) -> None:
        """Type a number into the field beside a slider, and leave it."""
        box = self.at(f"{name}-number")
        box.fill(f"{number:g}")
        box.press("Enter")

    def unfold(self) -> None:
        """Open all that is folded in the panel, one inside the other too."""
        self.page.evaluate("document.querySelectorAll('main details').forEach(one => one.open = true)")
        # What lies open is laid out with the next frame, and what follows from that shows in the one after.
        for _ in range(2):
            self.page.evaluate("new Promise(done => requestAnimationFrame(() => setTimeout(done)))")

    def facts(self, name: str) -> dict[str, str]:
        """Read a list of names and values."""
        pairs = "[...list.querySelectorAll('dt')].map(one => [one.textContent, one.nextElementSibling.textContent])"
        return self.at(name).evaluate(f"list => Object.fromEntries({pairs})")

    def table(self, name: str) -> list[list[str]]:
        """Read a table's rows, without its head."""
        rows = "[...table.querySelectorAll('tbody tr')].map(row => [...row.cells].map(cell => cell.textContent))"
        return self.at(name).evaluate(f"table => {rows}")

    def barriers(self) -> list[Any]:
        """Return what axe finds serious in the page; the visitor must have arrived with ``bypass_csp=True``."""
        if not self.page.evaluate("'axe' in window"):
            self.page.add_script_tag(path=AXE)
        found = self.page.evaluate("axe.run(document, { resultTypes: ['violations'] })")
        assert len(found["passes"]) > 15
        return [
            (one["id"], [node["html"][:120] for node in one["nodes"]])
            for one in found["violations"]
            if one["impact"] in ("serious", "critical")
        ]

    def check(self) -> None:
        """Refuse a page that complained, or asked anybody but its own server."""
        assert self.complaints == []
        own = {"", f"127.0.0.1:{self.server.settings.port}"}
        assert [url for url in self.requests if urlsplit(url).netloc not in own] == []


def numbers(text: str) -> list[float]:
    """Return the numbers in a text."""
    return [float(found) for found in re.findall(r"-?\d+(?:\.\d+)?", text)]


def number(text: str) -> float:
    """Return the first number in a text."""
    return numbers(text)[0]
