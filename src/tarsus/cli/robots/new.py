"""`tarsus robots new`: create a robot file from a template, or as a copy."""

from __future__ import annotations

from pathlib import Path

import click

from tarsus.cli.output import file_name, print_json, write_new
from tarsus.cli.values import examples, json_option

__all__ = ["new"]


@click.command(
    short_help="Write a robot file: a template or a copy.",
    epilog=examples(
        "tarsus robots new my-robot",
        "tarsus robots new my-freenove --from freenove",
        'tarsus robots new "my second robot" --out second.toml',
    ),
)
@click.argument("name")
@click.option("--from", "source", metavar="ROBOT", help="Copy a preset or a robot file.  [default: a template]")
@click.option("--out", type=click.Path(path_type=Path), metavar="FILE", help="Output file.  [default: NAME.toml]")
@json_option
def new(name: str, source: str | None, out: Path | None, as_json: bool) -> int:
    """Write a commented robot file called NAME: a symmetric hexapod as a template, or a copy of another robot.

    The template's masses are guesses, and marked as such. Where a copied robot has no masses, the file says what to
    measure. Existing files are not overwritten.
    """
    from tarsus.robot.copied import copied_text
    from tarsus.robot.file import robot_from_text, template_text

    text = template_text(name) if source is None else copied_text(source, name)
    # Rejects names that are not valid in a robot file.
    robot = robot_from_text(text, where=f"a robot called {name!r}")
    path = Path(f"{file_name(name)}.toml") if out is None else out
    write_new(path, text)
    if as_json:
        print_json({"name": name, "file": str(path), "from": source, "has_masses": robot.has_masses})
        return 0
    click.echo(f"wrote {path}; edit it, then run: tarsus robots check {path}")
    if not robot.has_masses:
        click.echo("its masses are not known: the file says what to weigh; without them there are no torques")
    return 0
