"""Many robots at once: `gymnasium.vector.VectorEnv`, on several threads."""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np
from gymnasium.vector import AutoresetMode, VectorEnv
from gymnasium.vector.utils import batch_space

from tarsus.errors import InputError
from tarsus.representation import represented
from tarsus.simulation.environment.walk_env import WalkEnv

if TYPE_CHECKING:
    from jaxtyping import Bool, Float, Shaped

__all__ = ["WalkVectorEnv"]

T = TypeVar("T")


@represented("num_envs", "threads", "autoreset_mode")
class WalkVectorEnv(VectorEnv[Any, Any, Any]):
    """Environments of one kind that are simulated in parallel: the engine's steps run without Python's global lock.

    Environment i with the seed s does what a `WalkEnv` with the seed s + i does, to the bit, for any number of threads.

    Parameters
    ----------
    num_envs : int
        Number of environments.
    max_episode_steps : int, optional
        Steps after which an episode is truncated; without limit where left out.
    threads : int, optional
        Number of threads; where left out, one for each core that this process may use.
    autoreset_mode : AutoresetMode or str
        When an environment begins its next episode: in the step after its end, in the same step (then ``"final_obs"``
        and ``"final_info"`` are in the infos), or never.
    **options
        Arguments of `WalkEnv`.

    Attributes
    ----------
    envs : tuple of WalkEnv
        The environments.
    threads : int
        Number of threads.

    Raises
    ------
    InputError
        If there is no environment or thread, or an option is out of its range.
    """

    def __init__(
        self,
        num_envs: int = 1,
        *,
        max_episode_steps: int | None = None,
        threads: int | None = None,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        **options: Any,
    ) -> None:
        self.threads = _cores() if threads is None else threads
        for name, value in (("num_envs", num_envs), ("threads", self.threads)):
            if value < 1:
                raise InputError(f"{name} is {value}; it must be at least 1")
        self.num_envs, self._limit = num_envs, max_episode_steps
        self.autoreset_mode = AutoresetMode(autoreset_mode)
        self.envs = tuple(WalkEnv(**options) for _ in range(num_envs))
        self.metadata = {**WalkEnv.metadata, "autoreset_mode": self.autoreset_mode}
        self.single_observation_space = self.envs[0].observation_space
        self.single_action_space = self.envs[0].action_space
        self.observation_space = batch_space(self.single_observation_space, num_envs)
        self.action_space = batch_space(self.single_action_space, num_envs)
        self._pool = ThreadPoolExecutor(self.threads)
        self._steps = np.zeros(num_envs, dtype=int)
        self._rewards = np.zeros(num_envs)
        self._ended, self._terminated, self._truncated = (np.zeros(num_envs, dtype=bool) for _ in range(3))
        self._observations = np.zeros((num_envs, *(self.single_observation_space.shape or ())), np.float32)

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Float[np.ndarray, "envs size"], dict[str, Any]]:
        """Begin an episode of each environment.

        Parameters
        ----------
        seed : int or sequence of int, optional
            Seed of the first environment, greater by one for each further environment; or a seed for each.
        options : dict, optional
            As for `WalkEnv.reset`, with ``"reset_mask"``, an array of bool, for some of the environments only.

        Returns
        -------
        observations, infos
        """
        seeds: Sequence[int | None] = [None] * self.num_envs if seed is None else []
        if seed is not None:
            seeds = [seed + number for number in range(self.num_envs)] if isinstance(seed, int | np.integer) else seed
        if len(seeds) != self.num_envs:
            raise InputError(f"there are {len(seeds)} seeds for {self.num_envs} environments; one for each is needed")
        wanted = dict(options or {})
        mask = np.asarray(wanted.pop("reset_mask", np.ones(self.num_envs, dtype=bool)))
        results = self._side_by_side(
            lambda number: self.envs[number].reset(seed=seeds[number], options=wanted), np.flatnonzero(mask).tolist()
        )
        self._steps[mask], self._ended[mask] = 0, False
        for number, (observation, _) in results.items():
            self._observations[number] = observation
        return self._observations.copy(), self._gathered({number: info for number, (_, info) in results.items()})

    def step(
        self, actions: Shaped[np.ndarray, "envs joints"]
    ) -> tuple[
        Float[np.ndarray, "envs size"],
        Float[np.ndarray, "envs"],
        Bool[np.ndarray, "envs"],
        Bool[np.ndarray, "envs"],
        dict[str, Any],
    ]:
        """Take a step of each environment.

        Parameters
        ----------
        actions : array, shape (envs, 3 * legs)
            The actions.

        Returns
        -------
        observations, rewards, terminations, truncations, infos
            ``infos["reward_terms"]`` has an array for each term.

        Raises
        ------
        InputError
            If an action has another size or is not finite, or, where none is reset by itself, an environment has ended.
        """
        if self.autoreset_mode is AutoresetMode.DISABLED and self._ended.any():
            raise InputError(f"environment {int(np.argmax(self._ended))} has ended; reset it before the next step")
        results = self._side_by_side(lambda number: self._step(number, actions[number]), range(self.num_envs))
        infos = {}
        for number, (observation, infos[number]) in results.items():
            self._observations[number] = observation
        return (
            self._observations.copy(),
            self._rewards.copy(),
            self._terminated.copy(),
            self._truncated.copy(),
            self._gathered(infos),
        )

    def _step(
        self, number: int, action: Shaped[np.ndarray, "joints"]
    ) -> tuple[Float[np.ndarray, "size"], dict[str, Any]]:
        """Take a step of an environment, or begin its next episode."""
        env = self.envs[number]
        if self._ended[number] and self.autoreset_mode is AutoresetMode.NEXT_STEP:
            self._rewards[number], self._steps[number] = 0.0, 0
            self._ended[number] = self._terminated[number] = self._truncated[number] = False
            return env.reset()
        observation, self._rewards[number], terminated, _, info = env.step(action)
        self._steps[number] += 1
        late = self._limit is not None and bool(self._steps[number] >= self._limit)
        self._terminated[number], self._truncated[number] = terminated, late
        self._ended[number] = terminated or late
        if self._ended[number] and self.autoreset_mode is AutoresetMode.SAME_STEP:
            self._ended[number], self._steps[number] = False, 0
            final = {"final_obs": observation, "final_info": info}
            observation, info = env.reset()
            info |= final
        return observation, info

    def _side_by_side(self, work: Callable[[int], T], numbers: Sequence[int]) -> dict[int, T]:
        """Return the results of work by number; of n threads, each takes every n-th number."""

        def share(thread: int) -> list[tuple[int, T]]:
            return [(number, work(number)) for number in numbers[thread :: self.threads]]

        return dict(sorted(itertools.chain(*self._pool.map(share, range(self.threads))), key=lambda each: each[0]))

    def _gathered(self, infos: Mapping[int, dict[str, Any]]) -> dict[str, Any]:
        """Return the infos of environments as Gymnasium gathers them: arrays, each with a mask."""
        found: dict[str, Any] = {}
        for number, info in infos.items():
            found = self._add_info(found, info, number)
        return found

    def close_extras(self, **_options: Any) -> None:
        """End the threads."""
        self._pool.shutdown()


def _cores() -> int:
    """Return how many cores this process may use, or the number of all where the system doesn't say."""
    return len(getattr(os, "sched_getaffinity", lambda _: range(os.cpu_count() or 1))(0))
