"""Train a policy for tarsus/Walk-v0 with PPO for a few minutes, and compare it with the walk controller.

    python examples/train_walk.py --minutes 7.5 --out trained

needs the extra "rl" (pip install 'tarsus[rl,sim,plots]'). It writes the policy (policy-*.zip), the learning curve
(learning-curve-*.csv and learning-curve.png) and the comparison (comparison.md) into the folder.
"""

from __future__ import annotations

import argparse
import csv
import time
from pathlib import Path
from typing import Any

import gymnasium
import numpy as np
import torch
from stable_baselines3 import PPO
from stable_baselines3.common.callbacks import BaseCallback
from stable_baselines3.common.vec_env import VecEnv, VecNormalize

from tarsus.simulation.environment import (
    EPISODE_STEPS,
    DomainRandomisation,
    Evaluation,
    ScriptedPolicy,
    WalkVectorEnv,
    evaluate,
)
from tarsus.simulation.terrain import Blocks

HARDEST = Blocks(rise=0.04, clear=0.3)
LEVELS = (Blocks(rise=0.03, clear=0.3), HARDEST)
GAMMA = 0.95
# Logarithm of the scale of exploration: an action of 1 is 0.15 rad as a residual, and the joint limit as a target.
EXPLORATION = {"residual": -2.0, "joint": -4.5}
# Evaluations draw their episodes from these seeds, training draws from others.
EVALUATION_SEED, EPISODES, FINAL_EPISODES = 10_000, 6, 20


class Threads(VecEnv):
    """The project's vector environment in the form that stable-baselines3 takes."""

    def __init__(self, env: WalkVectorEnv) -> None:
        self.env, self.render_mode = env, None
        super().__init__(env.num_envs, env.single_observation_space, env.single_action_space)

    def reset(self) -> np.ndarray:
        observations, _ = self.env.reset(seed=self._seeds[0])
        self._reset_seeds()
        return observations

    def step_async(self, actions: np.ndarray) -> None:
        self._results = self.env.step(actions)

    def step_wait(self) -> tuple[np.ndarray, np.ndarray, np.ndarray, list[dict[str, Any]]]:
        observations, rewards, terminated, truncated, infos = self._results
        each: list[dict[str, Any]] = [{"level": int(level)} for level in infos["level"]]
        for number in np.flatnonzero(terminated | truncated):
            each[number]["terminal_observation"] = infos["final_obs"][number]
            each[number]["TimeLimit.truncated"] = bool(truncated[number] and not terminated[number])
        return observations, rewards, terminated | truncated, each

    def close(self) -> None:
        self.env.close()

    def get_attr(self, attr_name: str, indices: Any = None) -> list[Any]:
        return [getattr(self.env.envs[number], attr_name) for number in self._get_indices(indices)]

    def set_attr(self, attr_name: str, value: Any, indices: Any = None) -> None:
        for number in self._get_indices(indices):
            setattr(self.env.envs[number], attr_name, value)

    def env_method(self, method_name: str, *args: Any, indices: Any = None, **kwargs: Any) -> list[Any]:
        return [getattr(self.env.envs[number], method_name)(*args, **kwargs) for number in self._get_indices(indices)]

    def env_is_wrapped(self, wrapper_class: Any, indices: Any = None) -> list[bool]:  # noqa: ARG002
        return [False for _ in self._get_indices(indices)]


class Curve(BaseCallback):
    """Evaluates the policy now and then, and ends the training when its time is over."""

    def __init__(self, env: gymnasium.Env[Any, Any], minutes: float, points: int) -> None:
        super().__init__()
        self.env, self.limit, self.points = env, 60 * minutes, points
        self.spent, self.since = 0.0, time.monotonic()
        self.rows: list[dict[str, float]] = []
        self.rewards: list[float] = []

    def _on_step(self) -> bool:
        self.rewards.append(float(self.training_env.get_original_reward().mean()))  # type: ignore[attr-defined]
        return self.spent + time.monotonic() - self.since < self.limit

    def _on_rollout_start(self) -> None:
        now = time.monotonic()
        self.spent += now - self.since
        if self.spent >= len(self.rows) / self.points * self.limit:
            self.add()
        self.since = time.monotonic()

    def add(self) -> None:
        """Evaluate; this time does not count as training."""
        found = evaluate(self.env, self.policy, episodes=EPISODES, seed=EVALUATION_SEED)
        levels = [info["level"] for info in self.locals.get("infos", [])] or [0]
        row = {"minutes": self.spent / 60, "steps": self.num_timesteps, "reward": found.reward, "error": found.error}
        self.rows.append({**row, "falls": found.falls, "mean level": float(np.mean(levels))})
        # Since the last evaluation, with exploration and on all levels.
        self.rows[-1]["training reward"] = float(np.mean(self.rewards or [float("nan")]))
        self.rewards.clear()
        print({name: round(value, 3) for name, value in self.rows[-1].items()}, flush=True)

    def policy(self, observation: np.ndarray) -> np.ndarray:
        action, _ = self.model.predict(observation, deterministic=True)
        return np.asarray(action)


def train(options: dict[str, Any], *, minutes: float, envs: int, seed: int, points: int) -> tuple[PPO, Curve]:
    """Return the trained policy and its learning curve."""
    vector = WalkVectorEnv(envs, max_episode_steps=EPISODE_STEPS, autoreset_mode="SameStep", terrain=LEVELS, **options)
    env = VecNormalize(Threads(vector), norm_obs=False, gamma=GAMMA)
    model = PPO(
        "MlpPolicy",
        env,
        n_steps=2048 // envs,
        batch_size=512,
        n_epochs=8,
        learning_rate=1e-3,
        # Exploration that is the same for the same state for half a second: white noise averages out within a step.
        use_sde=True,
        sde_sample_freq=25,
        # Steps of the gait are over in less than a second.
        gamma=GAMMA,
        gae_lambda=0.9,
        target_kl=0.05,
        policy_kwargs={"net_arch": {"pi": [32], "vf": [64, 64]}, "log_std_init": EXPLORATION[options["actions"]]},
        device="cpu",
        seed=seed,
    )
    curve = Curve(gymnasium.make("tarsus/Walk-v0", terrain=HARDEST, **options), minutes, points)
    model.learn(10**9, callback=curve)
    curve.spent = 60 * minutes
    curve.add()
    return model, curve


def baselines(options: dict[str, Any], episodes: int) -> dict[str, Evaluation]:
    """Return what the walk controller reaches, without readings and with them, and a rule that is added to it."""
    env = gymnasium.make("tarsus/Walk-v0", terrain=HARDEST, **{**options, "actions": "joint"})
    found = {}
    for name, feedback in (("walk controller, no readings", False), ("walk controller with readings", True)):
        policy = ScriptedPolicy(env, feedback=feedback)
        found[name] = evaluate(env, policy, episodes=episodes, seed=EVALUATION_SEED)
    residual = gymnasium.make("tarsus/Walk-v0", terrain=HARDEST, **options)
    swinging = residual.unwrapped.layout["walk_contacts"]  # type: ignore[attr-defined]

    def higher(observation: np.ndarray) -> np.ndarray:
        return np.outer(1 - observation[swinging], [0.0, 1.0, 0.0]).ravel()

    found["a rule: swinging femurs 0.15 rad higher"] = evaluate(
        residual, higher, episodes=episodes, seed=EVALUATION_SEED
    )
    return found


def draw(curves: dict[str, list[dict[str, float]]], found: dict[str, Evaluation], path: Path) -> None:
    """Draw reward and velocity error over the time of training, and those of other policies in the same episodes."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(9, 4), layout="constrained")
    for axes, key, label in zip(
        figure.subplots(1, 2), ("reward", "error"), ("reward of a step", "velocity error / top speed"), strict=True
    ):
        for name, rows in curves.items():
            axes.plot([row["minutes"] for row in rows], [row[key] for row in rows], marker="o", label=name)
        for colour, (name, result) in zip(("0.2", "0.5", "0.75"), found.items(), strict=False):
            axes.axhline(getattr(result, key), color=colour, linestyle="--", label=name)
        axes.set(xlabel="training (min)", ylabel=label)
        axes.grid(alpha=0.3)
    figure.legend(*figure.axes[0].get_legend_handles_labels(), loc="outside lower center", ncols=3, fontsize=8)
    figure.savefig(path, dpi=110)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--robot", default="strider")
    parser.add_argument("--sensors", default="hobby")
    parser.add_argument("--actions", nargs="+", default=["residual"], choices=("residual", "joint"))
    parser.add_argument("--minutes", type=float, default=7.5, help="of training, for each kind of actions")
    parser.add_argument("--envs", type=int, default=16)
    parser.add_argument("--points", type=int, default=8, help="of the learning curve")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--out", type=Path, default=Path("trained"))
    parser.add_argument(
        "--page", type=Path, help="a Markdown page whose table is to be replaced, and its figure written"
    )
    given = parser.parse_args()
    # The networks are small; the environments need the cores.
    torch.set_num_threads(1)
    given.out.mkdir(parents=True, exist_ok=True)
    common = {"robot": given.robot, "sensors": given.sensors, "randomisation": DomainRandomisation()}
    found, curves = baselines(common, FINAL_EPISODES), {}
    lines_in_figure = baselines(common, EPISODES)
    for name, result in found.items():
        print(name, result)
    for actions in given.actions:
        options = {**common, "actions": actions}
        model, curve = train(options, minutes=given.minutes, envs=given.envs, seed=given.seed, points=given.points)
        model.save(given.out / f"policy-{actions}.zip")
        name = f"PPO, {actions} actions"
        curves[name] = curve.rows
        found[name] = evaluate(curve.env, curve.policy, episodes=FINAL_EPISODES, seed=EVALUATION_SEED)
        print(name, found[name])
        with (given.out / f"learning-curve-{actions}.csv").open("w", newline="") as file:
            writer = csv.DictWriter(file, curve.rows[0])
            writer.writeheader()
            writer.writerows(curve.rows)
    draw(curves, lines_in_figure, given.out / "learning-curve.png")
    lines = ["| policy | reward of a step | velocity error | falls |", "|---|---|---|---|"]
    lines += [
        f"| {name} | {result.reward:.3f} | {result.error:.3f} | {100 * result.falls:.0f} % |"
        for name, result in found.items()
    ]
    (given.out / "comparison.md").write_text("\n".join(lines) + "\n")
    if given.page:
        draw(curves, lines_in_figure, given.page.parent / "figures" / f"{given.page.stem}.png")
        before, mark, rest = given.page.read_text().partition("<!-- table: policies -->\n")
        given.page.write_text(
            before + mark + "\n".join(lines) + "\n" + "<!-- end -->" + rest.partition("<!-- end -->")[2]
        )
    print("\n".join(lines))


if __name__ == "__main__":
    main()
