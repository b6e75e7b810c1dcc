"""`tarsus calibration schema`: print the JSON schema of calibration files."""

from __future__ import annotations

import json

import click

from tarsus.cli.values import examples

__all__ = ["schema"]


@click.command(
    short_help="Print the JSON schema of calibration files.",
    epilog=examples("tarsus calibration schema"),
)
@click.option("--json", "as_json", is_flag=True, help="No effect: the schema is JSON.")
def schema(as_json: bool) -> int:  # noqa: ARG001 - every command takes --json
    """Print the JSON schema of calibration files, for editors with TOML completion and validation."""
    from tarsus.hardware.calibration.schema import calibration_schema

    click.echo(json.dumps(calibration_schema(), indent=2))
    return 0
