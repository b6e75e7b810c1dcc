"""Measure Tarsus and print one table; `--write` also writes it to docs/benchmarks.md."""

from __future__ import annotations

import argparse
import importlib.util
import math
import platform
import shutil
import sys
from collections.abc import Callable, Iterator, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

# Must be imported before NumPy: it sets the core and the number of threads.
from measure import Row, medians, peak_bytes, start_time, use_one_core  # isort: split

import numpy as np

from loads import load_rows
from native import FLAGS, CLoop
from servo_buses import servo_bus_rows
from servo_plant import servo_plant_rows
from simulation import simulation_rows
from studio import studio_rows
from tarsus import (
    Gait,
    Pose,
    Robot,
    default_stance,
    forward_kinematics,
    inverse_kinematics,
    load_robot,
    plan_walk,
    straight_path,
)
from walk_controller import controller_rows

if TYPE_CHECKING:
    from jaxtyping import Float


ROBOTS = 100_000
"""Robots in a batch: 600,000 legs."""

DESIGNS, POSES = 1000, 32
BODY_HEIGHT = 0.11
MIN_C_RATIO = 0.15
"""Required speed relative to the C loop."""

SCATTERED_FRACTION = 0.001
"""Fraction of legs out of reach that affects almost every block of a batch."""

AGREEMENT = 1e-9
"""Tolerated difference between the angles of the two implementations [rad]."""

TABLE = Path(__file__).parent.parent / "docs" / "benchmarks.md"


def footholds(robot: Robot, rng: np.random.Generator) -> Float[np.ndarray, "..."]:
    """Return random feet in B around a stance, within reach for body tilts of up to 5 degrees about each axis."""
    spread = rng.uniform((-0.02, -0.02, 0.0), (0.02, 0.02, 0.01), (ROBOTS, robot.legs, 3))
    return np.asarray(default_stance(robot, BODY_HEIGHT, swing_height=0.05) + spread)


def tilted(degrees: float, rng: np.random.Generator) -> Pose:
    """Return random body poses, rotated by up to `degrees` about each axis and shifted by up to 10 mm."""
    roll, pitch, yaw = rng.uniform(-1, 1, (3, ROBOTS)) * math.radians(degrees)
    centre = np.array([0, 0, BODY_HEIGHT])
    return Pose.from_rpy(roll, pitch, yaw, rng.uniform(-0.01, 0.01, (ROBOTS, 3)) + centre)


def batches(robot: Robot) -> Iterator[tuple[str, Float[np.ndarray, "..."], Pose | None, float]]:
    """Yield the batches for both implementations: name, feet, body, fraction of legs out of reach."""
    rng = np.random.default_rng(1)
    feet = footholds(robot, rng)
    yield "feet in B", feet, None, 0.0
    for degrees in (2, 5):
        yield f"body poses, up to {degrees} deg", feet + np.array([0, 0, BODY_HEIGHT]), tilted(degrees, rng), 0.0
    g = robot.geometry
    outward = np.stack([g.cos_yaw, g.sin_yaw, np.zeros(robot.legs)], axis=-1)
    for fraction in (SCATTERED_FRACTION, 0.1):
        offset = np.where(rng.random((ROBOTS, robot.legs, 1)) < fraction, 0.3, 0.0) * outward
        yield f"feet in B, {fraction:.1%} out of reach", feet + offset, None, fraction


def require_agreement(
    c_loop: CLoop, robot: Robot, feet: Float[np.ndarray, "..."], body: Pose | None, out_of_reach: float
) -> None:
    """Check that both implementations agree, and that the fraction of legs out of reach is as stated."""
    solution = inverse_kinematics(robot, feet, body)
    c_loop(feet, body)
    difference = float(np.abs(solution.angles - c_loop.angles).max())
    codes = int((solution.reach != c_loop.codes).sum())
    if difference > AGREEMENT or codes:
        raise SystemExit(f"the C loop and Tarsus differ by up to {difference:.3g} rad, and in {codes} reach codes")
    fraction = float((c_loop.codes != 0).mean())
    if not math.isclose(fraction, out_of_reach, rel_tol=0.1):
        raise SystemExit(f"{fraction:.2%} of the legs are out of reach; expected {out_of_reach:.2%}")


def inverse_rows(robot: Robot, c_loop: CLoop | None) -> Iterator[Row]:
    """Measure whole-robot inverse kinematics with reach codes against a C loop."""
    for name, feet, body, out_of_reach in batches(robot):
        contestants: dict[str, Callable[[], object]] = {"tarsus": partial(inverse_kinematics, robot, feet, body)}
        if c_loop is not None:
            require_agreement(c_loop, robot, feet, body, out_of_reach)
            contestants["c"] = partial(c_loop, feet, body)
        times = medians(contestants, rounds=15)
        compared, met = "gcc is not installed: not compared", None
        if "c" in times:
            ratio = times["c"] / times["tarsus"]
            compared, met = f"C: {speed(times['c'])}; {ratio:.2f} of it", ratio >= MIN_C_RATIO
        yield Row(
            what=f"inverse kinematics with reach codes, {name}",
            measured=speed(times["tarsus"]),
            compared=compared,
            target=f">= {MIN_C_RATIO} of C",
            met=met,
        )


def speed(seconds: float, legs: int = 6 * ROBOTS) -> str:
    """Format a speed in legs per second."""
    return f"{legs / seconds / 1e6:.1f} M legs/s"


def single_rows(robot: Robot) -> Iterator[Row]:
    """Measure a single robot, as in a control loop."""
    feet = default_stance(robot, BODY_HEIGHT) * (1, 1, 0)
    body = Pose.from_rpy(0.03, -0.02, 0.1, (0.005, 0.0, BODY_HEIGHT))
    angles = inverse_kinematics(robot, feet, body).require().angles
    times = medians(
        {
            "inverse kinematics": lambda: inverse_kinematics(robot, feet, body),
            "forward kinematics": lambda: forward_kinematics(robot, angles),
        },
        loops=300,
    )
    for (name, seconds), limit in zip(times.items(), (60, 30), strict=True):
        yield Row(
            what=f"{name} of one robot{', with a body pose' if limit == 60 else ''}",
            measured=f"{seconds * 1e6:.0f} us",
            target=f"<= {limit} us",
            met=seconds * 1e6 <= limit,
        )


def memory_rows(robot: Robot) -> Iterator[Row]:
    """Measure the peak memory of solving a batch, relative to input and output."""
    for name, feet, body, out_of_reach in batches(robot):
        if out_of_reach == SCATTERED_FRACTION or name.endswith("2 deg"):
            continue  # same memory as another batch
        solution = inverse_kinematics(robot, feet, body)
        input_bytes = feet.nbytes + (0 if body is None else body.rotation.nbytes + body.position.nbytes)
        minimum_bytes = input_bytes + solution.angles.nbytes + solution.reach.nbytes
        del solution
        peak = input_bytes + peak_bytes(partial(inverse_kinematics, robot, feet, body))
        yield Row(
            what=f"memory for 600,000 legs, {name}",
            measured=f"{peak / 2**20:.0f} MiB",
            compared=f"input and output: {minimum_bytes / 2**20:.0f} MiB; {peak / minimum_bytes:.2f} times",
            target="< 5 times",
            met=peak < 5 * minimum_bytes,
        )


def forward_rows(robot: Robot) -> Iterator[Row]:
    """Measure forward kinematics, and forward and inverse kinematics with `jax.jit` on the same core."""
    feet = footholds(robot, np.random.default_rng(2))
    angles = inverse_kinematics(robot, feet).require().angles
    times = medians({"fk": lambda: forward_kinematics(robot, angles)})
    yield Row(what="forward kinematics, 600,000 legs", measured=speed(times["fk"]))
    if importlib.util.find_spec("jax") is None:
        yield Row(what="jax.jit, 600,000 legs", measured="JAX is not installed: not measured")
        return
    import jax

    jax.config.update("jax_enable_x64", True)
    jitted_ik = jax.jit(lambda feet: (s := inverse_kinematics(robot, feet)).angles + 0 * s.reach[..., None])
    jitted_fk = jax.jit(lambda angles: forward_kinematics(robot, angles))
    jax_feet, jax_angles = jax.numpy.asarray(feet), jax.numpy.asarray(angles)
    times |= medians(
        {
            "jax fk": lambda: jitted_fk(jax_angles).block_until_ready(),
            "jax ik": lambda: jitted_ik(jax_feet).block_until_ready(),
            "ik": lambda: inverse_kinematics(robot, feet),
            "fk": lambda: forward_kinematics(robot, angles),
        }
    )
    for name, what in (("ik", "inverse kinematics with reach codes"), ("fk", "forward kinematics")):
        yield Row(
            what=f"{what}, jax.jit, 600,000 legs",
            measured=speed(times[f"jax {name}"]),
            compared=f"NumPy: {speed(times[name])}; {times[name] / times[f'jax {name}']:.2f} of it",
        )


def design_rows(robot: Robot) -> Iterator[Row]:
    """Measure a batch of designs against a Python loop."""
    rng = np.random.default_rng(3)
    scale = rng.uniform(0.95, 1.05, (3, DESIGNS, 1))
    lengths = {name: getattr(robot, name) * scale[i] for i, name in enumerate(("coxa", "femur", "tibia"))}
    batch = robot.replace(**{name: length[:, None] for name, length in lengths.items()})
    designs = [robot.replace(**{name: length[i] for name, length in lengths.items()}) for i in range(DESIGNS)]
    feet = footholds(robot, rng)[:POSES]
    times = medians(
        {
            "one call": lambda: inverse_kinematics(batch, feet),
            "loop": lambda: [inverse_kinematics(design, feet) for design in designs],
        }
    )
    yield Row(
        what=f"inverse kinematics of {DESIGNS} designs in {POSES} poses, one call",
        measured=f"{times['one call'] * 1e3:.1f} ms",
        compared=f"a loop over the designs: {times['loop'] * 1e3:.0f} ms; "
        f"{times['loop'] / times['one call']:.1f} times as fast",
    )


def walk_rows(robot: Robot) -> Iterator[Row]:
    """Measure the planning of a walk of 1 m at 100 Hz."""
    gait, path = Gait.named("tripod"), straight_path(1.0)
    samples = {name: len(plan_walk(robot, gait, path, **input_bytes).time) for name, input_bytes in WALKS}
    times = medians({name: partial(plan_walk, robot, gait, path, **input_bytes) for name, input_bytes in WALKS})
    for name, seconds in times.items():
        yield Row(
            what=f"planning a walk of 1 m at 100 Hz, {name} ({samples[name]} samples)",
            measured=f"{seconds * 1e3:.1f} ms",
            target="<= 50 ms",
            met=seconds <= 0.05,
        )


WALKS: tuple[tuple[str, dict[str, Any]], ...] = (
    ("stroke given", {"stroke": 0.05}),
    ("stroke and cycle time by default", {}),
)


def start_rows() -> Iterator[Row]:
    """Measure start times of commands."""
    command = shutil.which("tarsus", path=str(Path(sys.executable).parent))
    commands: list[tuple[str, Sequence[str] | None]] = [
        ("import tarsus", (sys.executable, "-c", "import tarsus")),
        ("tarsus --help", None if command is None else (command, "--help")),
    ]
    for name, arguments in commands:
        if arguments is None:
            yield Row(what=name, measured="the command is not installed: not measured", target="< 0.3 s")
            continue
        seconds = start_time(arguments)
        yield Row(what=name, measured=f"{seconds:.2f} s", target="< 0.3 s", met=seconds < 0.3)


def rows(robot: Robot, c_loop: CLoop | None) -> Iterator[Row]:
    """Measure everything."""
    yield from inverse_rows(robot, c_loop)
    for group in (single_rows, memory_rows, forward_rows, design_rows, walk_rows, load_rows, controller_rows):
        yield from group(robot)
    yield from start_rows()
    yield from simulation_rows()
    yield from servo_bus_rows()
    yield from servo_plant_rows()
    yield from studio_rows()


WRITTEN = (
    "Written by `python benchmarks/run.py --write`; [how it is measured](../benchmarks/README.md). "
    "Absolute numbers depend on the machine, ratios less so."
)
HEADINGS = ("quantity", "median", "comparison", "target", "")


def cells(row: Row) -> tuple[str, ...]:
    """Return the columns of a row."""
    return row.what, row.measured, row.compared, row.target, row.verdict


def caption_of(c_loop: CLoop | None) -> str:
    """Return the caption: machine, versions, compiler."""
    compiled = "no gcc, so no C loop"
    if c_loop is not None:
        how = f"vectorised, with {', '.join(c_loop.vectors)}" if c_loop.vectors else "without vector functions"
        compiled = f"C: gcc {' '.join(FLAGS)}, {how}"
    return (
        f"One core ({platform.machine()}), Python {platform.python_version()}, "
        f"NumPy {np.__version__}; {compiled}. Batches have 600,000 legs: 100,000 robots."
    )


def show(table: Sequence[Row], caption: str) -> None:
    """Print the table."""
    from rich.console import Console
    from rich.table import Table

    shown = Table(*HEADINGS, title="Tarsus", caption=caption)
    for row in table:
        shown.add_row(*cells(row), style="red" if row.met is False else None)
    # Use a fixed width for a pipe, so that lines are not folded.
    Console(width=None if sys.stdout.isatty() else 170).print(shown)


def write(table: Sequence[Row], caption: str) -> None:
    """Write the table to the documentation."""
    lines = [
        "# Benchmarks",
        "",
        WRITTEN,
        "",
        caption,
        "",
        "| " + " | ".join(HEADINGS) + " |",
        "|---" * len(HEADINGS) + "|",
        *("| " + " | ".join(cells(row)) + " |" for row in table),
    ]
    TABLE.write_text("\n".join(lines) + "\n", encoding="utf-8")


def main() -> None:
    """Measure, print, and optionally write the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--write", action="store_true", help=f"write the table to {TABLE.parent.name}/{TABLE.name}")
    options = parser.parse_args()
    use_one_core()
    robot = load_robot("strider")
    c_loop = CLoop.compiled(robot, ROBOTS)
    table, caption = list(rows(robot, c_loop)), caption_of(c_loop)
    show(table, caption)
    if options.write:
        write(table, caption)


if __name__ == "__main__":
    main()
