"""Robots with random proportions feel the ground in physics: nothing is tuned for them."""

import pytest

import random_robots


@pytest.mark.no_cover
@pytest.mark.parametrize(
    ("seed", "ground"), [(5, "flat"), (8, "flat"), (22, "step up"), (18, "blocks"), (23, "blocks"), (11, "drop")]
)
def test_robots_with_random_proportions_walk_over_rough_ground_and_stop_before_a_drop(seed, ground):
    found = random_robots.walk((seed, ground))
    assert not found.touched
    assert found.steepest < 12
    if ground == "drop":
        assert found.way < 0.4
    else:
        assert found.way > 0.88
    if ground == "flat":
        assert found.slip < 0.02


@pytest.mark.no_cover
def test_a_foot_that_rises_along_a_block_from_lift_off_does_not_pull_the_robot_down():
    # It fell over by 45 deg.
    found = random_robots.walk((2, "blocks"))
    assert found.steepest < 20
    assert found.way > 0.88


def test_a_random_robot_is_the_same_again_and_each_is_another_one():
    first, again, other = (random_robots.random_robot(seed) for seed in (0, 0, 1))
    assert first == again
    assert first != other
