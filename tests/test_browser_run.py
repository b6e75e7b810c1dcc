"""The view Drive of a run: a page drives emulated servos, sees what they measure, and ends the run."""

from __future__ import annotations

from playwright.sync_api import expect

from browser import number
from sample_driven_machine import Machine

pytest_plugins = "browser_fixtures"


def test_a_page_drives_the_servos_of_a_run_and_ends_it(arrive):
    machine = Machine()
    with machine.going() as server:
        first = arrive(at=server, bypass_csp=True).open()
        expect(first.page.get_by_role("tab")).to_have_count(1)
        expect(first.at("run-bus")).to_have_text("emulated: feetech-sts")
        expect(first.at("run-robot")).to_have_text("strider")
        expect(first.at("drive-state")).to_have_text("standing")
        # A second page is refused while the first one is there.
        second = arrive(at=server).open()
        expect(second.at("failure")).to_contain_text("another visitor drives this robot")
        first.page.locator("main h2").click()
        first.page.keyboard.down("w")
        expect(first.at("drive-state")).to_contain_text("walking")
        expect(first.at("drive-facts")).to_contain_text("60 mm/s")
        behind = first.at("machine-facts").locator("dd").first
        expect(behind).to_contain_text("(")
        expect(behind).not_to_contain_text("0.0")
        facts = first.facts("machine-facts")
        assert 0 < number(facts["Farthest behind"]) < 30
        assert number(facts["Supply"]) > 6
        first.unfold()
        assert first.barriers() == []
        expect(first.at("angles")).to_contain_text("measured ones in brackets")
        # The page is closed with the key down: the robot stops, and stands when the next page drives.
        first.context.close()
        expect(second.at("failure")).to_be_visible()
        second.at("drive-again").click()
        expect(second.at("failure")).to_have_count(0)
        expect(second.at("drive-state")).to_have_text("standing")
        expect(second.at("drive-facts")).to_contain_text("Forward speed0 mm/s")
        assert machine.notes == ["the driver has left: stop"]
        second.at("end-run").click()
        # Once it stands, the run is over, and the servos are released.
        expect(second.at("drive-state")).to_have_text("standing")
        for _ in range(600):
            if not machine.recordings:
                second.page.wait_for_timeout(50)
        # A page that outlives its server complains that it can't connect.
        second.context.close()
    (recording,) = machine.recordings
    assert recording.ok
    assert recording.states[-1] == "standing"
    assert not any(servo.torque for servo in machine.line.servos.values())
