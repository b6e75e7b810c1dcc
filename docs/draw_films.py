"""Films of walks in physics, blind beside felt: python docs/draw_films.py (`make figures`)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import tarsus
from rough_ground import CLEAR
from tarsus.report.film import Film
from tarsus.report.view import View
from tarsus.simulation import SimulatedPlant, TracedPlant, terrain
from tarsus.simulation.truth.as_motion import trace_motion

if TYPE_CHECKING:
    from PIL.Image import Image

    from tarsus.simulation import Terrain

FIGURES = Path(__file__).parent / "figures"
GROUNDS = {
    "blocks": terrain.Blocks(rise=0.04, clear=CLEAR, seed=3),
    "stairs": terrain.Stairs(rise=0.035),
}
# Every walk takes this long [s]; a frame shows each interval of it for half as long, [s] and [ms].
DURATION, INTERVAL, SHOWN = 9.0, 0.2, 100
SIZE, QUALITY = (400, 390), 50
# From behind: the faces of stairs that go up are seen.
VIEW = View(azimuth=-125.0, elevation=24.0)


def walked(ground: Terrain, sensors: str, words: str) -> list[Image]:
    """Return the frames of a walk at half the top speed."""
    robot = tarsus.load_robot("strider")
    speed = 0.5 * tarsus.WalkController(robot).top_speed((1, 0, 0))
    plant = TracedPlant(SimulatedPlant(robot, terrain=ground, sensors=sensors))
    recording = tarsus.run(tarsus.RobotController(robot), plant, [(0.0, (speed, 0.0, 0.0))], duration=DURATION)
    motion = trace_motion(plant.trace, recording.motion)
    film = Film(motion, view=VIEW, size=SIZE, height=ground.height)
    label = film.figure.text(0.985, 0.975, "", fontsize=11, va="top", ha="right")
    forward, frames = motion.body.position[:, 0], []
    for sample in range(0, len(motion.time), round(INTERVAL * recording.rate)):
        way, commanded = forward[sample] - forward[0], speed * motion.time[sample]
        label.set_text(f"{words}\n{way:.2f} m of {commanded:.2f} m")
        frames.append(film.frame(sample))
    return frames


def draw_films() -> None:
    """Write a film for each ground: left without readings, right with foot contacts and attitude."""
    from PIL import Image

    for name, ground in GROUNDS.items():
        frames = []
        walks = walked(ground, "blind", "blind"), walked(ground, "ideal", "felt")
        for blind, felt in zip(*walks, strict=True):
            both = Image.new("RGB", (2 * SIZE[0], SIZE[1]))
            both.paste(blind, (0, 0))
            both.paste(felt, (SIZE[0], 0))
            frames.append(both)
        frames[0].save(
            FIGURES / f"felt-{name}.webp",
            save_all=True,
            append_images=frames[1:],
            duration=[SHOWN] * (len(frames) - 1) + [1000],
            loop=0,
            quality=QUALITY,
            method=6,
        )


if __name__ == "__main__":
    draw_films()
