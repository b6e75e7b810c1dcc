"""`tarsus robots schema`: the JSON schema of a robot file."""

from __future__ import annotations

import json

import click

from tarsus.cli.values import examples

__all__ = ["schema"]


@click.command(
    epilog=examples(
        "tarsus robots schema",
    )
)
@click.option("--json", "as_json", is_flag=True, help="The schema is JSON in any case.")
def schema(as_json: bool) -> int:  # noqa: ARG001 - every command takes --json
    """Print the JSON schema of a robot file, for editors that complete and check TOML."""
    from tarsus.robot.file import robot_schema

    # To the byte the file that comes with Tarsus.
    click.echo(json.dumps(robot_schema(), indent=2))
    return 0
