"""tarsus/Walk-v0: Gymnasium's checks, seeds, actions, observations, rewards, commands, curriculum, many at once."""

import dataclasses
import itertools
import math
import re
import warnings
from importlib import import_module
from pathlib import Path

import gymnasium
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from tarsus.control.walk_controller import WalkController
from tarsus.errors import InputError, SimulationError, TarsusError, UnknownNameError
from tarsus.kinematics.mass import total_mass
from tarsus.robot.file import load_robot
from tarsus.simulation import ServoModel, SimulatedPlant
from tarsus.simulation.environment import (
    EPISODE_STEPS,
    WALK,
    CommandSampler,
    DomainRandomisation,
    RewardWeights,
    ScriptedPolicy,
    TerrainCurriculum,
    WalkEnv,
    WalkVectorEnv,
    evaluate,
    gymnasium_extra,
)
from tarsus.simulation.environment.command_sampler import top_speeds
from tarsus.simulation.environment.registration import register_walk
from tarsus.simulation.terrain import Blocks, Flat, HeightField, Ramp

STRIDER = load_robot("strider")
NOTHING = np.zeros(18, np.float32)
FORWARD = {"command": (0.08, 0.0, 0.0)}


@pytest.fixture(scope="module")
def residual():
    return WalkEnv(STRIDER)


@pytest.fixture(scope="module")
def joint():
    return WalkEnv(STRIDER, sensors="blind", actions="joint")


@pytest.mark.parametrize(
    "options",
    [
        {},
        {"sensors": "ideal", "actions": "joint", "randomisation": DomainRandomisation(), "terrain": Blocks(rise=0.01)},
    ],
)
def test_gymnasium_finds_nothing_wrong(options):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(gymnasium.make(f"tarsus.simulation.environment:{WALK}", **options).unwrapped)


def test_it_is_registered_once_with_a_time_limit():
    register_walk()
    env = gymnasium.make(WALK, max_episode_steps=3, sensors="blind")
    env.reset(seed=0)
    assert [env.step(NOTHING)[3] for _ in range(3)] == [False, False, True]
    assert gymnasium.spec(WALK).max_episode_steps == EPISODE_STEPS == 500
    many = gymnasium.make_vec(WALK, num_envs=2, sensors="blind", threads=1)
    assert isinstance(many, WalkVectorEnv)
    assert many.num_envs == 2
    many.close()


def episode(env, seed, steps=12):
    """Observations, rewards and joint targets of random actions."""
    random, found = np.random.default_rng(seed), [env.reset(seed=seed)[0]]
    for _ in range(steps):
        observation, reward, *_ = env.step(random.uniform(-1, 1, 18))
        found += [observation, np.array([reward]), env.targets.ravel(), env.command]
    return np.concatenate(found)


def test_a_seed_determines_the_episode_to_the_bit():
    options = {"randomisation": DomainRandomisation(), "terrain": (Flat(), Blocks(rise=0.02, clear=0.0))}
    env = WalkEnv(STRIDER, **options)
    first, other = episode(env, 5), episode(env, 6)
    assert np.array_equal(episode(env, 5), first)
    assert np.array_equal(episode(WalkEnv("strider", **options), 5), first)
    assert not np.array_equal(first, other)


def test_observations_are_what_the_sensors_measure(residual):
    observation, info = residual.reset(seed=3, options=FORWARD)
    assert set(residual.layout) == {
        *("command", "contacts", "attitude", "angular_rates", "targets", "walk_angles", "walk_contacts")
    }
    for _ in range(15):
        observation, _, _, _, info = residual.step(0.1 * np.ones(18))
    part = {name: observation[where] for name, where in residual.layout.items()}
    standing = residual.step.__self__._start.angles
    assert part["command"] == pytest.approx(np.array(FORWARD["command"]) / residual.top_speeds)
    assert (part["contacts"] == residual.readings.contacts).all()
    assert part["attitude"] == pytest.approx(residual.readings.attitude / 0.2, rel=1e-5)
    assert part["angular_rates"] == pytest.approx(residual.readings.angular_rates, rel=1e-5)
    assert part["targets"] == pytest.approx((residual.targets - standing).ravel() / 0.5, abs=1e-6)
    assert (info["command"] == FORWARD["command"]).all()
    assert sum(each.stop - each.start for each in residual.layout.values()) == observation.size
    assert residual.observation_space.contains(observation)


def test_without_sensors_there_are_a_clock_and_the_last_targets(joint):
    joint.reset(seed=1, options=FORWARD)
    assert set(joint.layout) == {"command", "targets", "clock"}
    for number in range(1, 4):
        observation, *_ = joint.step(NOTHING)
        phase = math.tau * number * 0.02 / WalkController(STRIDER).cycle_time
        assert observation[joint.layout["clock"]] == pytest.approx([math.sin(phase), math.cos(phase)], abs=1e-6)


def test_no_residual_is_the_walk_controller(residual):
    residual.reset(seed=2, options=FORWARD)
    walk = WalkController(STRIDER)
    angles = walk.angles
    for _ in range(40):
        observation, *_ = residual.step(NOTHING)
        assert residual.targets == pytest.approx(angles, abs=1e-15)
        angles = walk.step(FORWARD["command"], 0.02)
        assert (observation[residual.layout["walk_contacts"]] == walk.contacts).all()


def test_residuals_are_added_within_the_joint_limits(residual):
    residual.reset(seed=2, options=FORWARD)
    before = residual.targets
    residual.step(2 * np.ones(18))
    assert residual.targets - before == pytest.approx(0.15)
    assert residual.action_of(residual.targets) == pytest.approx(np.ones(18), abs=0.3)
    wide = WalkEnv(STRIDER, sensors="blind", residual=4.0)
    wide.reset(seed=1)
    wide.step(np.ones(18))
    assert wide.targets == pytest.approx(STRIDER.limits[..., 1])


def test_joint_actions_reach_from_limit_to_limit(joint):
    standing = np.asarray(joint.reset(seed=1)[0][joint.layout["targets"]])
    assert (standing == 0).all()
    for action, expected in ((np.ones(18), STRIDER.limits[..., 1]), (-np.ones(18), STRIDER.limits[..., 0])):
        joint.reset(seed=1)
        joint.step(action)
        assert joint.targets == pytest.approx(expected)
        assert joint.action_of(joint.targets) == pytest.approx(action)
    action = np.random.default_rng(1).uniform(-1, 1, 18)
    joint.reset(seed=1)
    joint.step(action)
    assert joint.action_of(joint.targets) == pytest.approx(action, abs=1e-6)


@pytest.mark.parametrize("action", [np.zeros(17), np.full(18, np.nan)])
def test_an_action_that_cannot_be_is_refused(joint, action):
    joint.reset(seed=1)
    with pytest.raises(InputError, match="an action must be 18 finite numbers"):
        joint.step(action)


def test_the_reward_is_the_sum_of_its_terms(joint):
    weights = RewardWeights()
    joint.reset(seed=4, options=FORWARD)
    random, before, velocity = np.random.default_rng(1), joint.targets, np.zeros(3)
    for _ in range(20):
        start = joint.plant.state.body
        _, reward, _, _, info = joint.step(random.uniform(-0.3, 0.3, 18))
        state, terms = joint.plant.state, info["reward_terms"]
        # In the heading frame half-way through the step.
        yaw = (start.rpy[2] + state.body.rpy[2]) / 2
        heading = np.array([[math.cos(yaw), math.sin(yaw)], [-math.sin(yaw), math.cos(yaw)]])
        moved = [*(heading @ (state.body.position - start.position)[:2]), state.body.rpy[2] - start.rpy[2]]
        velocity += (np.array(moved) / 0.02 - velocity) * (1 - math.exp(-0.02 / 0.25))
        assert info["velocity"] == pytest.approx(velocity, abs=1e-9)
        error = (velocity - FORWARD["command"]) / joint.top_speeds
        stall, rates = joint.plant.servos[0][0].stall_torque, (joint.targets - before) / 0.02
        tilt = math.acos(state.body.rotation[2, 2])
        power = np.abs(state.torques * state.joint_speeds).sum()
        assert terms == pytest.approx(
            {
                "velocity": weights.velocity * math.exp(-(error[0] ** 2 + error[1] ** 2) / 0.25**2),
                "turning": weights.turning * math.exp(-(error[2] ** 2) / 0.25**2),
                "tilt": weights.tilt * (tilt / math.radians(10)) ** 2,
                "rocking": weights.rocking * (joint.plant.mj_data.qvel[3:5] ** 2).sum(),
                "torque": weights.torque * ((state.torques / stall) ** 2).mean(),
                "power": weights.power * power / (float(total_mass(STRIDER)) * 9.80665 * joint.top_speeds[0]),
                "target_rate": weights.target_rate * ((rates / 5) ** 2).mean(),
                "fall": 0.0,
            }
        )
        assert reward == pytest.approx(sum(terms.values()))
        before = joint.targets


def test_an_episode_ends_when_the_body_touches_the_ground(joint):
    joint.reset(seed=1, options=FORWARD)
    lift = np.tile([0.0, 1.0, 0.0], 6)
    ends = [joint.step(lift) for _ in range(40)]
    first = [each[2] for each in ends].index(True)
    assert joint.plant.state.body_touches
    assert ends[first][1] == pytest.approx(sum(ends[first][4]["reward_terms"].values()))
    assert ends[first][4]["reward_terms"]["fall"] == -10


def test_what_becomes_unstable_has_fallen(joint):
    joint.reset(seed=1)
    joint.plant.mj_data.qvel[0] = 5e3
    observation, reward, terminated, truncated, info = joint.step(NOTHING)
    assert (reward, terminated, truncated) == (-10.0, True, False)
    assert info["reward_terms"]["fall"] == -10
    assert joint.observation_space.contains(observation)


def test_an_episode_that_ends_unstable_leads_to_no_higher_level(monkeypatch):
    env = WalkEnv(STRIDER, sensors="blind", terrain=TerrainCurriculum([Flat(), Flat(), Flat()], level=1))
    env.reset(seed=1, options=FORWARD)
    for _ in range(150):
        env.step(NOTHING)

    def unstable(*_):
        raise SimulationError("unstable")

    monkeypatch.setattr(env.plant, "execute", unstable)
    assert env.step(NOTHING)[2]
    assert env.reset(options=FORWARD)[1]["level"] == 0


@pytest.mark.no_cover
def test_the_scripted_policy_and_no_residual_follow_commands_on_flat_ground():
    options = {"sensors": "blind", "max_episode_steps": 150, "commands": CommandSampler(standing=0.0)}
    plain = gymnasium.make(WALK, **options)
    found = evaluate(plain, lambda observation: NOTHING, episodes=2, seed=1)
    scripted = gymnasium.make(WALK, actions="joint", **options)
    expected = evaluate(scripted, ScriptedPolicy(scripted), episodes=2, seed=1)
    assert found.error < 0.1
    assert expected.error < 0.1
    assert found.reward == pytest.approx(expected.reward, rel=0.1)
    assert (found.falls, found.episodes) == (0, 2)
    assert found.reward == pytest.approx(sum(found.reward_terms.values()))
    short = gymnasium.make(WALK, actions="joint", sensors="blind", max_episode_steps=1)
    assert math.isnan(evaluate(short, ScriptedPolicy(short, feedback=False), episodes=1).error)


def test_what_cannot_be_evaluated_is_refused(residual):
    with pytest.raises(InputError, match="episodes is 0; it must be at least 1"):
        evaluate(residual, lambda observation: NOTHING, episodes=0)
    for env in (residual, gymnasium.Env()):
        with pytest.raises(InputError, match="needs the environment tarsus/Walk-v0 with actions='joint'"):
            ScriptedPolicy(env)


def test_commands_are_drawn_within_what_the_robot_can_sustain():
    walk, random = WalkController(STRIDER), np.random.default_rng(1)
    top = top_speeds(walk)
    sampler = CommandSampler(forward=(0.2, 1.0), left=(-1.0, 0.0), turning=(0.5, 0.5), standing=0.2)
    twists = np.array([sampler.sample(walk, top, random) for _ in range(100)])
    standing = ~twists.any(axis=1)
    assert 0.1 < standing.mean() < 0.3
    moving = twists[~standing]
    assert all(walk.top_speed(twist) > 1 for twist in moving.tolist())
    assert (moving * [1, -1, 1] >= 0).all()
    assert (sampler.sample(walk, 0 * top, random) == 0).all()


def test_commands_change_within_an_episode_and_can_be_kept():
    env = WalkEnv(STRIDER, sensors="blind", commands=CommandSampler(every=0.1, standing=0.0))
    env.reset(seed=1)
    seen = [env.step(NOTHING)[4]["command"] for _ in range(11)]
    changed = [not np.array_equal(a, b) for a, b in itertools.pairwise(seen)]
    assert [number + 1 for number, each in enumerate(changed) if each] == [5, 10]


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: CommandSampler(forward=(0.5, -0.5)), r"forward is \(0.5, -0.5\); it must be two fractions"),
        (lambda: CommandSampler(left=(-2, 1)), "left is"),
        (lambda: CommandSampler(standing=1.5), r"standing is 1.5; it must be in \[0, 1\]"),
        (lambda: CommandSampler(every=0.0), "every is 0"),
        (lambda: DomainRandomisation(mass=(0.0, 1.0)), r"mass is \(0, 1\); it must be two positive factors"),
        (lambda: DomainRandomisation(delay=(2.0, math.inf)), "delay is"),
        (lambda: RewardWeights(tilt=math.nan), "the weight of tilt is nan; it must be finite"),
        (lambda: TerrainCurriculum([3]), "the curriculum's levels must be terrains; 3 is none"),
        (
            lambda: TerrainCurriculum([]),
            r"the curriculum's levels must be a sequence of at least one terrain, got \[\]",
        ),
        (lambda: WalkEnv(terrain=3), "must be a sequence of at least one terrain, got 3"),
        (lambda: TerrainCurriculum(level=1), "level is 1; the curriculum has the levels 0 to 0"),
        (lambda: WalkEnv(actions="torque"), "Did you mean|kind of action"),
        (lambda: WalkEnv(residual=-1.0), "residual is -1"),
        (lambda: WalkVectorEnv(0), "num_envs is 0; it must be at least 1"),
        (lambda: WalkVectorEnv(1, threads=0), "threads is 0"),
    ],
)
def test_what_cannot_be_is_refused(make, message):
    with pytest.raises((InputError, UnknownNameError), match=message):
        make()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"speed": 1}, "unknown option 'speed' of reset; there are 'command' and 'level'"),
        ({"command": (1.0, 2.0)}, "it must be three finite numbers"),
        ({"command": (1.0, 2.0, math.nan)}, "it must be three finite numbers"),
        ({"level": 3}, "level is 3; the curriculum has the levels 0 to 0"),
    ],
)
def test_options_of_reset_that_cannot_be_are_refused(joint, options, message):
    with pytest.raises(InputError, match=message):
        joint.reset(options=options)


def test_domain_randomisation_changes_robot_servos_and_friction_within_its_ranges():
    ranges, random = DomainRandomisation(), np.random.default_rng(1)
    nominal = ServoModel.of(STRIDER.servos[0][0])
    found = [ranges.sample(STRIDER, "catalogue", random) for _ in range(50)]
    servos = [[servo for row in domain.servos for servo in row] for domain in found]
    for name, attribute in (
        ("stiffness", "stiffness"),
        ("stall_torque", "no_load_speed"),
        ("backlash", "dead_band"),
        ("delay", "delay"),
    ):
        factors = np.array([[getattr(servo, attribute) for servo in each] for each in servos])
        factors /= getattr(nominal, attribute)
        low, high = getattr(ranges, name)
        assert low - 1e-9 <= factors.min() < low + 0.1 * (high - low)
        assert high - 0.1 * (high - low) < factors.max() <= high + 1e-9
        assert (np.ptp(factors, axis=1) == 0).all() == (name == "delay")
    masses = np.array([domain.robot.body_mass for domain in found]) / STRIDER.body_mass
    assert (masses.min() > 0.9, masses.max() < 1.2, np.ptp(masses) > 0.2) == (True, True, True)
    env = WalkEnv(STRIDER, sensors="blind", randomisation=ranges)
    plants = []
    for seed in (1, 2):
        env.reset(seed=seed)
        plants.append(env.plant)
    assert plants[0].terrain.friction != plants[1].terrain.friction
    assert plants[0].robot.body_mass != plants[1].robot.body_mass
    assert plants[0].servos != plants[1].servos


def test_a_robot_that_makes_its_way_goes_up_a_level_and_one_that_does_not_down():
    curriculum, random = TerrainCurriculum([Flat(), Ramp(slope=0.1), Blocks()]), np.random.default_rng(1)
    curriculum.finish(0.9, fallen=False, random=random)
    assert curriculum.level == 1
    curriculum.finish(0.6, fallen=False, random=random)
    assert curriculum.level == 1
    curriculum.finish(0.9, fallen=False, random=random)
    assert curriculum.level == 2
    seeds = {curriculum.terrain(1.0, random).seed for _ in range(3)}
    assert len(seeds) == 3
    curriculum.finish(0.9, fallen=True, random=random)
    curriculum.finish(0.3, fallen=False, random=random)
    curriculum.finish(0.3, fallen=False, random=random)
    assert curriculum.level == 0
    assert curriculum.terrain(1.0, random) is curriculum.levels[0]
    assert curriculum.terrain(0.5, random).friction == 0.4
    curriculum.go_to(2)
    levels = set()
    for _ in range(20):
        curriculum.finish(1.0, fallen=False, random=random)
        levels.add(curriculum.level)
        curriculum.go_to(2)
    assert levels == {0, 1, 2}


def test_the_environment_follows_its_curriculum():
    curriculum = TerrainCurriculum([Flat(), Flat(friction=0.5)])
    env = WalkEnv(STRIDER, sensors="blind", terrain=curriculum)
    env.reset(seed=1, options=FORWARD)
    for _ in range(150):
        _, _, _, _, info = env.step(NOTHING)
    assert info["level"] == 0
    assert env.reset(options=FORWARD)[1]["level"] == 1
    assert env.plant.terrain.friction == 0.5
    assert env.reset()[1]["level"] == 1
    assert env.reset(options={"level": 0})[1]["level"] == 0
    assert env.reset(options={"level": 1})[1]["level"] == 1
    assert env.reset(seed=1)[1]["level"] == 0


def test_height_fields_are_terrains_of_the_environment():
    ground = HeightField(heights=np.zeros((5, 5)), size=(4.0, 4.0))
    env = WalkEnv(STRIDER, sensors="blind", terrain=ground)
    env.reset(seed=1)
    env.reset()
    assert env.plant.terrain is ground


def test_each_of_many_environments_has_its_own_level():
    curriculum = TerrainCurriculum([Flat(), Flat(), Flat()])
    many = WalkVectorEnv(2, terrain=curriculum, sensors="blind", threads=1)
    many.reset(seed=1, options=FORWARD)
    for _ in range(150):
        many.step(np.zeros((2, 18), dtype=np.float32))
    assert many.reset()[1]["level"].tolist() == [1, 1]
    assert curriculum.level == 0
    many.close()


@pytest.mark.parametrize("threads", [1, 2])
def test_many_at_once_do_what_each_does_alone(threads):
    options = {"randomisation": DomainRandomisation(), "sensors": "hobby"}
    many = WalkVectorEnv(3, threads=threads, max_episode_steps=4, **options)
    random = np.random.default_rng(0)
    first, infos = many.reset(seed=7)
    alone = [gymnasium.make(WALK, max_episode_steps=4, **options) for _ in range(3)]
    assert np.array_equal(first, [env.reset(seed=7 + number)[0] for number, env in enumerate(alone)])
    assert infos["command"].shape == (3, 3)
    for step in range(7):
        actions = random.uniform(-1, 1, (3, 18)).astype(np.float32)
        observations, rewards, terminated, truncated, infos = many.step(actions)
        if step == 4:
            # The step after the end begins the next episode.
            expected = [(env.reset()[0], 0.0, False, False) for env in alone]
        else:
            expected = [env.step(action)[:4] for env, action in zip(alone, actions, strict=True)]
        assert np.array_equal(observations, [each[0] for each in expected])
        assert rewards.tolist() == [each[1] for each in expected]
        assert terminated.tolist() == [each[2] for each in expected]
        assert truncated.tolist() == [each[3] for each in expected] == [step == 3] * 3
        total = sum(value for name, value in infos["reward_terms"].items() if not name.startswith("_"))
        assert total == pytest.approx(rewards)
    many.close()


def test_episodes_can_begin_in_the_same_step_or_never():
    many = WalkVectorEnv(2, max_episode_steps=2, autoreset_mode="SameStep", sensors="blind")
    many.reset(seed=1)
    many.step(np.zeros((2, 18)))
    observations, _, _, truncated, infos = many.step(np.zeros((2, 18)))
    assert truncated.all()
    assert infos["final_info"]["velocity"].shape == (2, 3)
    assert not np.array_equal(infos["final_obs"][0], observations[0])
    assert not many.step(np.zeros((2, 18)))[3].any()
    many.close()
    never = WalkVectorEnv(2, max_episode_steps=1, autoreset_mode="Disabled", sensors="blind")
    never.reset(seed=[1, 2])
    never.step(np.zeros((2, 18)))
    with pytest.raises(InputError, match="environment 0 has ended; reset it before the next step"):
        never.step(np.zeros((2, 18)))
    never.reset(options={"reset_mask": np.array([True, False])})
    with pytest.raises(InputError, match="environment 1 has ended"):
        never.step(np.zeros((2, 18)))
    with pytest.raises(InputError, match="there are 3 seeds for 2 environments"):
        never.reset(seed=[1, 2, 3])
    never.close()


@pytest.mark.parametrize("number", range(3))
def test_the_examples_of_the_page_run(number, capsys):
    page = (Path(__file__).parents[1] / "docs" / "reinforcement-learning.md").read_text(encoding="utf-8")
    exec(compile(re.findall(r"```python\n(.*?)```", page, flags=re.DOTALL)[number], "example", "exec"), {})
    assert re.search(["'walk_contacts'", "0", "Evaluation"][number], capsys.readouterr().out)


def test_the_page_states_the_weights_of_the_reward():
    page = (Path(__file__).parents[1] / "docs" / "reinforcement-learning.md").read_text(encoding="utf-8")
    weights = dict(re.findall(r"^\| (\w+) \| (-?[\d.]+) \| ", page.partition("## Reward")[2], flags=re.MULTILINE))
    assert {name: float(value) for name, value in weights.items()} == dataclasses.asdict(RewardWeights())


def test_a_plant_that_has_not_been_started_has_no_readings():
    with pytest.raises(InputError, match="has not been started"):
        _ = SimulatedPlant(STRIDER).readings


def test_without_gymnasium_the_error_says_what_to_install(monkeypatch):
    def missing(name):
        raise ImportError(name) if name == "gymnasium" else AssertionError

    monkeypatch.setattr(gymnasium_extra, "import_module", missing)
    with pytest.raises(TarsusError, match=r"pip install 'tarsus\[rl\]'"):
        gymnasium_extra.require_gymnasium()
    assert import_module("tarsus.simulation").environment.WALK == WALK
