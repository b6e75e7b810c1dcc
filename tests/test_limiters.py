"""The limiter protocols: how limiters combine, and what each of them decides."""

from functools import reduce
from types import SimpleNamespace

import numpy as np
import pytest

from tarsus import Gait, load_robot
from tarsus.control.command import Command
from tarsus.control.limitation import Limitation, LimitationKind
from tarsus.control.limiter.pending_transition import PendingTransitionLimiter
from tarsus.control.limiter.protocol import TwistGrant, TwistRequest
from tarsus.control.readings import SensorReadings
from tarsus.control.tick.limit import twist_limiters
from tarsus.control.walk.felt_feet import FeltFoot
from tarsus.control.walk.reference_governor import FootPrediction
from tarsus.control.walk_controller import WalkController

DT = 0.02
LIMITATION = Limitation(kind=LimitationKind.TWIST, cause="test", asked=1.0, granted=0.5)


class Half:
    """Allows half."""

    def limit(self, _, grant):
        return grant.at_most(0.5, LIMITATION)


class Third:
    """Allows a third."""

    def limit(self, _, grant):
        return grant.at_most(1 / 3)


def request(controller, twist):
    return TwistRequest(twist, DT, controller._tick.gait, controller._tick.twist)


def granted(limiters, asked):
    return reduce(lambda grant, limiter: limiter.limit(asked, grant), limiters, TwistGrant())


def walking(*commands, seconds=3.0, **options):
    controller = WalkController(load_robot("strider"), Gait.named("tripod"), **options)
    for command in commands:
        for _ in range(round(seconds / DT)):
            controller.step(command, DT)
    return controller


def test_the_smallest_fraction_counts_and_all_limitations():
    controller = walking()
    grant = granted([Half(), Third(), Half()], request(controller, (0.3, 0.0, 0.6)))
    assert grant.fraction == 1 / 3
    assert grant.limitations == (LIMITATION, LIMITATION)
    assert grant.target is None
    assert grant.scaled((0.3, 0.0, 0.6)) == pytest.approx([0.1, 0.0, 0.2])


def test_a_further_limiter_is_one_more_item_in_the_list():
    controller = WalkController(load_robot("strider"), Gait.named("tripod"))
    controller._twist_limiters.insert(0, Half())
    for _ in range(200):
        controller.step((0.1, 0.0, 0.0), DT)
    np.testing.assert_allclose(controller.twist, (0.05, 0.0, 0.0), atol=1e-9)
    assert controller.limitations == (LIMITATION,)


def test_without_feedback_and_transitions_only_workspace_and_governor_limit():
    controller = walking((0.1, 0.0, 0.0))
    asked = request(controller, (0.1, 0.0, 0.0))
    for limiter in twist_limiters(controller._walk)[:-1]:
        assert limiter.limit(asked, TwistGrant()) == TwistGrant()
    fast = granted(twist_limiters(controller._walk), request(controller, (3.0, 0.0, 0.0)))
    assert fast.fraction == pytest.approx(controller.top_speed((3.0, 0.0, 0.0)))
    (limitation,) = fast.limitations
    assert limitation.granted == fast.fraction
    assert limitation.leg in controller.robot.leg_names


def examined_targets(controller, monkeypatch):
    """Return a list that grows with each target that a controller's governor examines."""
    found, governor = [], controller._twist_limiters[-1]
    governed = governor._governed
    monkeypatch.setattr(governor, "_governed", lambda *given: found.append(given) or governed(*given))
    return found


def test_a_target_that_is_met_is_examined_again_only_when_the_stance_changes(monkeypatch):
    sparing, thorough = (WalkController(load_robot("strider"), Gait.named("ripple")) for _ in range(2))
    examined = examined_targets(sparing, monkeypatch)
    for tick in range(400):
        command = ((0.04, 0.02, 0.1), (0.4, 0.0, 0.0), (0.0, 0.0, 0.5), (0.0, 0.0, 0.0))[tick // 100]
        thorough._twist_limiters[-1]._command = []
        np.testing.assert_array_equal(sparing.step(command, DT), thorough.step(command, DT))
    assert len(examined) < 200


def test_a_walk_that_feels_the_ground_examines_targets_as_often_as_it_looks_at_it(monkeypatch):
    controller = WalkController(load_robot("strider"), Gait.named("tripod"))
    examined, targets = examined_targets(controller, monkeypatch), set()
    for _ in range(100):
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0))
        controller.step((1.0, 0.0, 0.0), 0.01, readings)
        targets.add(tuple(controller._tick.twist.tolist()))
    assert 3 < len(targets) <= len(examined) < 50


def test_a_felt_walk_that_begins_keeps_its_feet_in_their_workspaces():
    controller = WalkController(load_robot("makeyourpet"))
    speed, transitions = 0.5 * controller.top_speed((1.0, 0.0, 0.0)), controller._walk.transitions
    for _ in range(12):
        readings = SensorReadings(contacts=controller.contacts, attitude=(0.0, 0.0))
        before = controller._tick.gait
        controller.step((speed, 0.0, 0.0), 0.01, readings)
        if not before.down.all():
            prediction = FootPrediction.of(before, *transitions.stance_intervals(before), transitions.bandwidth)
            # The first feet lifted off at the full twist, and those that stand were 11 mm outside at their lift-off.
            assert prediction.excess(controller._tick.twist[None], transitions.bounds).max() < 1e-4


def test_a_governor_that_stops_the_walk_says_why():
    controller = walking()
    asked = request(controller, (0.1, 0.0, 0.0))
    behind = asked.state._replace(foothold=asked.state.foothold - 0.1)
    grant = granted(twist_limiters(controller._walk), asked._replace(state=behind))
    assert not grant.target.any()
    (limitation,) = grant.limitations
    assert limitation.text() == "twist: 0 % of the command; standing feet would leave their workspaces"
    assert granted(twist_limiters(controller._walk), asked).limitations == ()


def test_a_foot_that_waits_on_felt_ground_takes_the_time_in_which_it_would_fall_behind():
    controller = walking()
    transitions, state = controller._walk.transitions, controller._tick.gait
    late = state._replace(down=np.ones_like(state.down), clock=state.clock + 1.0)
    felt = late._replace(felt=[FeltFoot()] * len(late.down))
    in_time, waiting, felt_waiting = (transitions.stance_intervals(each)[1] for each in (state, late, felt))
    reserve = waiting.min()
    assert 0.0 < reserve < in_time.max()
    assert (felt_waiting <= waiting).all()
    assert felt_waiting.min() == 0.0


class Waiting:
    """A transition that can't begin."""

    waiting, scheduler = True, SimpleNamespace(planned=None)


def test_a_transition_that_waits_slows_the_walk_down_and_is_reported_when_it_lasts():
    controller, transitions = walking(), Waiting()
    limiter = PendingTransitionLimiter(transitions)
    fractions = [limiter.limit(request(controller, (0.1, 0.0, 0.0)), TwistGrant()) for _ in range(200)]
    assert fractions[49].fraction == pytest.approx(np.exp(-1.0))
    assert fractions[49].limitations == ()
    (limitation,) = fractions[-1].limitations
    assert limitation.granted == fractions[-1].fraction < 0.05
    assert limiter.limit(request(controller, (0.0, 0.0, 0.0)), TwistGrant()).limitations == ()
    transitions.waiting = False
    assert limiter.limit(request(controller, (0.1, 0.0, 0.0)), TwistGrant()) == TwistGrant()


def test_a_transition_that_waits_slows_down_a_walk_that_is_slow_for_another_reason():
    controller = walking()
    limiter = PendingTransitionLimiter(Waiting())
    for _ in range(200):
        grant = limiter.limit(request(controller, (0.1, 0.0, 0.0)), TwistGrant(1e-4))
    assert grant.fraction == grant.limitations[0].granted == pytest.approx(1e-4 * np.exp(-4.0))


@pytest.mark.parametrize(("name", "body"), [("phantomx", (0, 0, 0, 0, 0.3, 0)), ("strider", (0, 0, 0, 1.0, 0, 0))])
def test_a_walk_leaves_a_pose_at_the_end_of_the_legs_reach_within_seconds(name, body):
    controller = WalkController(load_robot(name))
    twist = (0.5 * controller.top_speed((1, 0, 0)), 0.0, 0.0)
    for command in (Command(twist=twist, body=body), Command(twist=twist, body=(0.0,) * 6)):
        # Held at 0.01 % of its command, the walk began to change its pose only after 8 s.
        for _ in range(round(6.0 / DT)):
            controller.step(command, DT)
    assert controller.body.rpy == pytest.approx((0.0, 0.0, 0.0), abs=1e-3)
    assert controller.limitations == ()


def test_the_walk_slows_down_for_another_gait_no_more_than_needed():
    controller = walking((0.2, 0.0, 0.0), Command(twist=(0.2, 0.0, 0.0), gait="wave"), seconds=6.0)
    assert controller.gait.name == "wave"
    (limitation,) = controller.limitations
    assert limitation.kind is LimitationKind.TWIST
