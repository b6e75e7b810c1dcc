"""Whatever is commanded, and whenever: the invariants hold. Half an hour of walking in all."""

import numpy as np
import pytest
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import RuleBasedStateMachine, initialize, rule

from gait_robots import PRESETS, preset, ring
from tarsus.control.command import Command
from tarsus.control.pose.admittance import Admittance
from tarsus.control.readings import SensorReadings
from tarsus.control.walk_controller import WalkController
from tarsus.gait.gait import Gait
from walk_trace import GAITS, LONGEST_TICK, Trace, drive

# Coverage is measured by the other tests: tracing would nearly double the time of these.
pytestmark = [pytest.mark.lengthy, pytest.mark.no_cover]

SECONDS = 30.0
GIVING = Admittance(mass=1.0, damping=40.0, stiffness=400.0)


@pytest.mark.parametrize("seed", range(0, 40, 3))
def test_any_stream_of_commands_keeps_the_invariants(seed):
    name, gait = PRESETS[seed % len(PRESETS)], GAITS[seed // len(PRESETS) % len(GAITS)]
    drive(WalkController(preset(name), Gait.named(gait)), seed, SECONDS).assert_sound()


@pytest.mark.parametrize("seed", [*range(300, 306), 1023])
def test_foot_targets_and_a_swaying_body_keep_them(seed):
    controller = WalkController(
        preset(PRESETS[seed % len(PRESETS)]), Gait.named(GAITS[seed // len(PRESETS) % len(GAITS)])
    )
    drive(controller, seed, SECONDS, with_foot_targets=True).assert_sound()


@pytest.mark.parametrize("seed", range(100, 105))
def test_implausible_readings_keep_them(seed):
    controller = WalkController(preset(PRESETS[seed % len(PRESETS)]), levelling="level", admittance=GIVING)
    broken = drive(controller, seed, SECONDS, sensing=True).broken(flat=False)
    # Where ground is felt that no robot stands on, its feet search for it.
    assert not [found for found in broken if "joint" in found or "finite" in found]


@pytest.mark.no_cover
@pytest.mark.parametrize("seed", range(200, 202))
def test_ticks_of_a_millisecond_keep_them(seed):
    controller = WalkController(preset(PRESETS[seed % len(PRESETS)]))
    trace, rng = Trace(controller), np.random.default_rng(seed)
    for twist in rng.normal(size=(6, 3)) * [0.3, 0.3, 1.0]:
        trace.step(Command(twist=twist, gait=str(rng.choice(GAITS))), 0.001)
        for _ in range(400):
            trace.step(twist, float(rng.uniform(0.001, 0.004)))
    trace.assert_sound()


numbers = st.floats(-1, 1, allow_subnormal=False)
triples, sextuples = st.tuples(*[numbers] * 3), st.tuples(*[numbers] * 6)
anything = st.one_of(
    st.none(),
    st.floats(),
    st.text(max_size=2),
    st.booleans(),
    st.lists(st.floats() | st.booleans() | st.none(), max_size=7),
    st.lists(st.lists(st.floats(), max_size=4), max_size=7),
)


class AnyCommands(RuleBasedStateMachine):
    """A walker, and everything that can be asked of it in any order."""

    @initialize(
        name=st.sampled_from([*PRESETS, "ring"]), gait=st.sampled_from(GAITS), cycle_time=st.none() | st.floats(0.2, 3)
    )
    def begin(self, name, gait, cycle_time):
        robot = ring(6) if name == "ring" else preset(name)
        self.trace = Trace(WalkController(robot, Gait.named(gait), cycle_time=cycle_time))
        self.body_height, self.swing_height = self.trace.controller.body.position[2], robot.gait.swing_height or 0.03
        self.twist, self.dt, self.readings = (0.0, 0.0, 0.0), 0.03, {}

    def ask(self, **changes):
        self.trace.step(Command(twist=self.twist, **changes), self.dt, **self.readings)

    @rule(twist=triples, size=st.sampled_from([0.05, 0.2, 1.0, 1e3]))
    def walk(self, twist, size):
        self.twist = tuple(size * v * weight for v, weight in zip(twist, (1, 1, 3), strict=True))
        self.ask()

    @rule(gait=st.sampled_from(GAITS))
    def change_gait(self, gait):
        self.ask(gait=gait)

    @rule(body=sextuples, size=st.sampled_from([0.3, 1.0, 30.0]))
    def move_body(self, body, size):
        self.ask(body=tuple(size * v * w for v, w in zip(body, (0.03, 0.03, 0.03, 0.2, 0.2, 0.2), strict=True)))

    @rule(share=st.floats(0.1, 3))
    def change_clearance(self, share):
        self.ask(body_height=share * self.body_height)

    @rule(share=st.floats(0, 3))
    def change_lift(self, share):
        self.ask(swing_height=share * self.swing_height)

    @rule(width=st.floats(-0.1, 0.1))
    def change_width(self, width):
        self.ask(stance_width=width)

    @rule(cycle_time=st.floats(0.1, 5))
    def change_pace(self, cycle_time):
        self.ask(cycle_time=cycle_time)

    @rule(sway=sextuples)
    def sway(self, sway):
        self.ask(sway=tuple(0.02 * v for v in sway))

    @rule(leg=st.integers(0, 5), point=triples)
    def take_leg(self, leg, point):
        self.ask(foot_targets={leg: tuple(self.trace.controller.feet[leg] + 0.1 * np.array(point))})

    @rule(leg=st.integers(0, 5), speed=triples)
    def move_leg(self, leg, speed):
        self.ask(foot_velocities={leg: tuple(0.1 * v for v in speed)})

    @rule()
    def give_legs_back(self):
        self.ask(foot_targets=dict.fromkeys(range(6)))

    @rule(dt=st.floats(0.001, LONGEST_TICK))
    def change_tick(self, dt):
        self.dt = dt

    @rule(contacts=anything, attitude=anything, forces=anything, torques=anything)
    def feel_garbage(self, contacts, attitude, forces, torques):
        # Contacts that could be true would be believed, and this ground is known to be flat.
        contacts = contacts if not isinstance(contacts, list) or len(contacts) != 6 else "garbage"
        readings = SensorReadings(contacts=contacts, attitude=attitude, forces=forces, torques=torques)
        self.readings = {"readings": readings}
        self.ask()

    @rule()
    def feel_nothing(self):
        self.readings = {}
        self.ask()

    @rule(ticks=st.sampled_from([1, 10, 40, 120, 240]))
    def go_on(self, ticks):
        for _ in range(ticks):
            self.trace.step(self.twist, self.dt, **self.readings)

    def teardown(self):
        if hasattr(self, "trace"):
            self.trace.assert_sound()


class TestAnyCommands(AnyCommands.TestCase):
    settings = settings(max_examples=16, stateful_step_count=40)
