"""Fixtures of the end-to-end tests; a module takes them by ``pytest_plugins = "browser_fixtures"``."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, sync_playwright

from browser import DESK, Visitor, launch
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Settings


@pytest.fixture(scope="session")
def chromium() -> Iterator[Browser]:
    """One browser for all tests of a worker."""
    with sync_playwright() as playwright:
        browser = launch(playwright)
        yield browser
        browser.close()


@pytest.fixture(scope="session")
def server() -> Iterator[Serving]:
    """One server for all tests of a worker: every visitor has a session of their own."""
    with Serving(Settings()) as serving:
        yield serving


@pytest.fixture
def arrive(chromium: Browser, server: Serving) -> Iterator[Callable[..., Visitor]]:
    """Let visitors come: each with a browser profile of their own, all checked in the end."""
    come: list[Visitor] = []

    def arriving(*, at: Serving = server, **options: Any) -> Visitor:
        context = chromium.new_context(
            **{"viewport": DESK, "reduced_motion": "reduce", "accept_downloads": True, **options}
        )
        context.grant_permissions(["clipboard-read", "clipboard-write"])
        come.append(Visitor.of(at, context))
        return come[-1]

    yield arriving
    for visitor in come:
        visitor.context.close()
    for visitor in come:
        visitor.check()


@pytest.fixture
def visitor(arrive: Callable[..., Visitor]) -> Visitor:
    """A visitor at a desk."""
    return arrive()
