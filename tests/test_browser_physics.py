"""Physics in the page: the switch, the terrain, the walk and the driven robot."""

from __future__ import annotations

from playwright.sync_api import expect

import tarsus
from browser import number
from tarsus import simulation
from tarsus.studio.messages.state import Straight, StudioState, WalkOptions

pytest_plugins = "browser_fixtures"

SHORT = StudioState(view="walk", walk=WalkOptions(path=Straight(kind="straight", distance_mm=60.0)))


def test_the_walk_and_the_driven_robot_are_shown_in_physics(visitor):
    visitor.open(SHORT)
    expect(visitor.at("walk-verdict")).to_be_visible()
    expect(visitor.at("simulated-verdict")).to_have_count(0)
    visitor.at("physics-on").check()
    expect(visitor.at("simulated-verdict")).to_contain_text("In physics: completed")
    expect(visitor.at("chip-tilt")).to_contain_text("tilt 0.")
    flat = visitor.facts("simulated-facts")
    visitor.at("terrain").select_option("ramp")
    visitor.type("terrain-start", -200)
    visitor.type("terrain-slope", -12)
    motion = tarsus.plan_walk(tarsus.load_robot("strider"), tarsus.Gait.named("tripod"), tarsus.straight_path(0.06))
    truth = simulation.compare(motion, terrain=simulation.terrain_from_text("ramp:start=-200,slope=-12"))
    way = f"{100 * truth.outcome.way_ratio:.1f} % of the plan"
    expect(visitor.at("simulated-facts")).to_contain_text(way)
    assert visitor.facts("simulated-facts") != flat
    visitor.view("drive")
    expect(visitor.at("drive-facts")).to_contain_text("Tilt from the commanded pose")
    assert number(visitor.facts("drive-facts")["Distance from the commanded place"]) < 100
    expect(visitor.at("force-LF")).to_contain_text("N")
    # What is changed while driving starts the robot anew, as planned too.
    visitor.at("physics-off").check()
    expect(visitor.at("drive-facts")).not_to_contain_text("Tilt")
    expect(visitor.at("chip-tilt")).to_have_count(0)


def test_without_the_engine_the_switch_says_what_to_install(visitor, monkeypatch):
    monkeypatch.setattr("tarsus.studio.physics.terrains.engine_problem", lambda: "install it with: pip install sim")
    visitor.open(SHORT)
    expect(visitor.at("physics-missing")).to_contain_text("install it with: pip install sim")
    expect(visitor.at("physics-on")).to_be_disabled()
