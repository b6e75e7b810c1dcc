"""`tarsus robots new`: create a robot file from a template."""

from __future__ import annotations

from pathlib import Path

import click

from tarsus.cli.output import print_json
from tarsus.cli.values import examples, json_option

__all__ = ["new"]


@click.command(
    epilog=examples(
        "tarsus robots new my-robot",
        'tarsus robots new "my second robot" --out second.toml',
    )
)
@click.argument("name")
@click.option("--out", type=click.Path(path_type=Path), metavar="FILE", help="Output file.  [default: NAME.toml]")
@json_option
def new(name: str, out: Path | None, as_json: bool) -> int:
    """Write a commented robot file of a symmetric hexapod called NAME.

    Existing files are not overwritten.
    """
    from tarsus.robot.file import robot_from_text, template_text

    text = template_text(name)
    # Rejects names that are not valid in a robot file.
    robot_from_text(text, where=f"a robot called {name!r}")
    path = Path(f"{_as_file_name(name)}.toml") if out is None else out
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise click.UsageError(f"{path} already exists; choose another file with --out") from None
    except (OSError, ValueError) as error:
        raise click.UsageError(f"{path} can't be written: {error}") from None
    if as_json:
        print_json({"name": name, "file": str(path)})
    else:
        click.echo(f"wrote {path}; edit it, then run: tarsus robots check {path}")
    return 0


def _as_file_name(name: str) -> str:
    """Return a name without separators or characters that are special to a shell."""
    return "".join(letter if letter.isalnum() or letter in "-_" else "-" for letter in name)[:100]
