"""The bring-up in the page: questions and answers by mouse and keyboard, left and resumed."""

from __future__ import annotations

import re

import numpy as np
import pytest
from playwright.sync_api import expect

import tarsus
from tarsus.hardware import Calibration, ManualClock
from tarsus.hardware.bringup import trial
from tarsus.hardware.bringup.emulated_machine import EmulatedMachine
from tarsus.studio.machine.hardware import Hardware
from tarsus.studio.messages.state import StudioState
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Settings

pytest_plugins = "browser_fixtures"

STRIDER = tarsus.load_robot("strider")
ROBOT = StudioState(view="robot")
FILE = "strider.calibration.toml"


@pytest.fixture
def truth(tmp_path, monkeypatch):
    """An emulated machine whose front left leg is not calibrated yet, and of which all else is known."""
    monkeypatch.setattr(trial, "_WALK_TIME", 0.2)
    truth = EmulatedMachine(STRIDER, "feetech-sts").truth
    begun = truth
    for joint in range(3):
        unknown = {"zero": None} | ({"number": None, "direction": None} if joint < 2 else {})
        begun = begun.with_joint(0, joint, **unknown)
    begun.save(tmp_path / FILE)
    return truth


def asked(visitor, text):
    expect(visitor.at("question")).to_contain_text(text)


def choose(visitor, name):
    """Press the button of a choice, once the page takes answers."""
    visitor.page.locator(".choices").get_by_role("button", name=re.compile(rf"^{name}\b")).click()


def identify(visitor, truth):
    """Say what is true of the servo that has moved."""
    asked(visitor, "Which leg moved?")
    said = visitor.at("bring-up-said").locator("li").last.inner_text()
    number = int(re.search(r"id (\d+) moves", said)[1])
    joint = [each.number for each in truth.joints[0]].index(number)
    choose(visitor, "front left")
    asked(visitor, "Which joint?")
    choose(visitor, ("coxa", "femur")[joint])
    asked(visitor, "Which way did it go first?")
    positive = "rearward" if joint == 0 else "up"
    negative = "forward" if joint == 0 else "down"
    choose(visitor, positive if truth.joints[0][joint].direction > 0 else negative)


def test_a_machine_is_brought_up_in_the_page(arrive, truth, tmp_path):
    hardware = Hardware(tmp_path, clock=ManualClock())
    with Serving(Settings(hardware=hardware)) as server:
        visitor = arrive(at=server, bypass_csp=True).open(ROBOT)
        visitor.unfold()
        visitor.at("bring-up").click()
        expect(visitor.at("bring-up-known")).to_have_text("15 of 18 joints are calibrated")
        identify(visitor, truth)
        asked(visitor, "Which leg moved?")
        assert visitor.barriers() == []
        # Left in the middle; a second visitor is refused before, and may go on afterwards.
        other = arrive(at=server).open(ROBOT)
        other.unfold()
        other.at("bring-up").click()
        expect(other.at("failure").first).to_contain_text("another visitor uses the servos")
        visitor.at("bring-up-leave").click()
        expect(visitor.at("bring-up-end")).to_contain_text("What was answered is saved")
        assert sum(joint.number is None for joint in Calibration.load(tmp_path / FILE).joints[0]) == 1
        visitor.at("bring-up-again").click()
        identify(visitor, truth)
        # The rest by keyboard alone.
        asked(visitor, "The front left leg is limp: hold it in the reference pose.")
        expect(visitor.at("question")).to_be_focused()
        visitor.page.keyboard.press("Enter")
        for name in STRIDER.leg_names:
            asked(visitor, f"Limits of the {name} leg:")
            visitor.page.keyboard.press("Enter")
        expect(visitor.at("bring-up-known")).to_have_text("18 of 18 joints are calibrated")
        asked(visitor, "put the robot on a box")
        visitor.page.keyboard.press("Enter")
        asked(visitor, "Does every leg look like the drawing?")
        visitor.page.keyboard.press("Enter")
        asked(visitor, "A slow walk in the air")
        visitor.page.keyboard.press("n")
        expect(visitor.at("bring-up-end")).to_contain_text("All joints are calibrated")
        visitor.at("bring-up-close").click()
        expect(visitor.at("robot-facts")).to_be_visible()
        # A page that outlives its server complains that it can't connect.
        for each in (visitor, other):
            each.context.close()
    made = Calibration.load(tmp_path / FILE)
    assert [joint.number for joint in made.joints[0]] == [joint.number for joint in truth.joints[0]]
    assert [joint.direction for joint in made.joints[0]] == [joint.direction for joint in truth.joints[0]]
    assert np.abs(np.degrees((made.zeros - truth.zeros) / made.slopes)).max() < 0.6


def test_a_public_studio_says_why_it_brings_up_nothing(arrive):
    with Serving(Settings(public=True)) as server:
        visitor = arrive(at=server).open(ROBOT)
        visitor.unfold()
        expect(visitor.at("no-hardware")).to_contain_text("any visitor could move the servos")
        expect(visitor.at("bring-up")).to_be_disabled()
        visitor.context.close()
