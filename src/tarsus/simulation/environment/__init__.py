"""Walking as an environment for reinforcement learning: ``tarsus/Walk-v0`` of Gymnasium.

Importing this package registers it::

    import gymnasium
    import tarsus.simulation.environment

    env = gymnasium.make("tarsus/Walk-v0", robot="strider", sensors="hobby")
    many = gymnasium.make_vec("tarsus/Walk-v0", num_envs=64, robot="strider")

So does ``gymnasium.make("tarsus.simulation.environment:tarsus/Walk-v0")``, without any import. The extra ``rl``
installs Gymnasium.
"""

from __future__ import annotations

from tarsus.simulation.environment.gymnasium_extra import require_gymnasium

require_gymnasium()

from tarsus.simulation.environment.body_motion import BodyMotion  # noqa: E402 - without Gymnasium, say what installs it
from tarsus.simulation.environment.command_sampler import CommandSampler  # noqa: E402
from tarsus.simulation.environment.domain_randomisation import DomainRandomisation  # noqa: E402
from tarsus.simulation.environment.evaluation import Evaluation, evaluate  # noqa: E402
from tarsus.simulation.environment.registration import EPISODE_STEPS, WALK, register_walk  # noqa: E402
from tarsus.simulation.environment.reward import RewardWeights  # noqa: E402
from tarsus.simulation.environment.scripted_policy import ScriptedPolicy  # noqa: E402
from tarsus.simulation.environment.terrain_curriculum import TerrainCurriculum  # noqa: E402
from tarsus.simulation.environment.walk_env import WalkEnv  # noqa: E402
from tarsus.simulation.environment.walk_vector_env import WalkVectorEnv  # noqa: E402

__all__ = [
    "EPISODE_STEPS",
    "WALK",
    "BodyMotion",
    "CommandSampler",
    "DomainRandomisation",
    "Evaluation",
    "RewardWeights",
    "ScriptedPolicy",
    "TerrainCurriculum",
    "WalkEnv",
    "WalkVectorEnv",
    "evaluate",
]

register_walk()
