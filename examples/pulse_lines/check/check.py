"""Compile the sketch, and compare it with the emulated board over random lines: ``make sketch``."""

from __future__ import annotations

import random
import subprocess
import sys
import tempfile
from pathlib import Path

from tarsus import hardware
from tarsus.hardware.codec import lines

HERE = Path(__file__).parent
LINES, CHANNELS, INPUTS = 3000, 18, 6


def random_line(chance: random.Random) -> bytes:
    """Return a line that sets pulses, one that is wrong, damaged or something else, or noise."""
    kind = chance.random()
    if kind < 0.5:
        return lines.pulses([chance.choice([0, 500, 2500, chance.randint(500, 2500)]) for _ in range(CHANNELS)])
    if kind < 0.6:
        return lines.pulses([chance.choice([0, 7, 499, 2501, 99999]) for _ in range(CHANNELS)])
    if kind < 0.65:
        return lines.watchdog(chance.choice([0, 55, 505, 60_000]))
    if kind < 0.7:
        return chance.choice([lines.ASK, lines.INPUTS])
    if kind < 0.85:
        damaged = bytearray(lines.pulses([1500] * CHANNELS))
        damaged[chance.randrange(len(damaged))] ^= 1 << chance.randrange(7)
        return bytes(damaged)
    return chance.randbytes(chance.randrange(20)) + b"\n"


def main() -> None:
    """Compare, and say what differs."""
    chance, board = random.Random(2), hardware.emulate("lines", range(CHANNELS))
    board.receive(lines.checked("begin"), 0.0)
    with tempfile.TemporaryDirectory() as folder:
        program = Path(folder) / "sketch"
        command = ["g++", "-std=c++17", "-Wall", "-Wextra", "-Werror", "-I", str(HERE), "-o", str(program)]
        subprocess.run([*command, str(HERE / "host.cpp")], check=True)
        with subprocess.Popen([str(program)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as sketch:
            assert sketch.stdin is not None
            assert sketch.stdout is not None
            milliseconds = 0
            for number in range(LINES):
                milliseconds += chance.choice([10, 20, 300, 700])
                line, levels = random_line(chance), [chance.randrange(2) for _ in range(INPUTS)]
                board.levels = dict(enumerate(levels))
                sent = b"".join(one.data for one in board.receive(line, milliseconds / 1e3))
                sketch.stdin.write(f"{milliseconds} {''.join(map(str, levels))} {line.hex()}\n")
                sketch.stdin.flush()
                answer = sketch.stdout.readline().strip()
                expected = " ".join([f"[{sent.hex()}]", *(f"{width:.0f}" for width in board.pulses.values())])
                if answer != expected:
                    sys.exit(f"line {number}, {line!r}:\nsketch    {answer}\nemulation {expected}")
            sketch.stdin.close()
    print(f"{LINES} lines: the sketch sets the same pulses as the emulated board")


if __name__ == "__main__":
    main()
