"""`tarsus robots schema`: print the JSON schema of robot files."""

from __future__ import annotations

import json

import click

from tarsus.cli.values import examples

__all__ = ["schema"]


@click.command(
    short_help="Print the JSON schema of robot files.",
    epilog=examples(
        "tarsus robots schema",
    ),
)
@click.option("--json", "as_json", is_flag=True, help="No effect: the schema is JSON.")
def schema(as_json: bool) -> int:  # noqa: ARG001 - every command takes --json
    """Print the JSON schema of robot files, for editors with TOML completion and validation."""
    from tarsus.robot.schema import robot_schema

    # Identical to the bundled file.
    click.echo(json.dumps(robot_schema(), indent=2))
    return 0
