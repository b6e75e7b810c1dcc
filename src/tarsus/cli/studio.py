"""`tarsus studio`: the robot in the browser, live."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

import click

from tarsus.cli.output import print_json
from tarsus.cli.values import examples, json_option

if TYPE_CHECKING:
    from tarsus.studio.messages.state import StudioState
    from tarsus.studio.server.serve import Serving

__all__ = ["studio"]

_PORT = 8600


@click.command(
    epilog=examples(
        "tarsus studio --check",
        "tarsus studio phantomx --check --json",
        "tarsus studio strider --port 0 --no-browser --check",
        "tarsus studio --host 0.0.0.0 --check",
        "tarsus studio --host 0.0.0.0 --public --check",
    )
)
@click.argument("robot", metavar="[ROBOT]", default="strider")
@click.option(
    "--port", type=click.IntRange(0, 65535), help=f"Port to listen at; 0 takes a free one.  [default: {_PORT}]"
)
@click.option("--host", default="127.0.0.1", show_default=True, help="Address to listen at; others need a token.")
@click.option("--public", is_flag=True, help="Let anybody in without a token, to the simulator and nothing else.")
@click.option("--token", help="The token that visitors must know.  [default: a new one where --host needs one]")
@click.option("--no-browser", is_flag=True, help="Print the link, and open no browser.")
@click.option("--check", is_flag=True, help="Start, ask the server whether all is well, and stop.")
@json_option
def studio(
    robot: str,
    port: int | None,
    host: str,
    public: bool,
    token: str | None,
    no_browser: bool,
    check: bool,
    as_json: bool,
) -> int:
    """Open the robot in the browser, to look at it and move it. Without --check it runs until Ctrl-C.

    Only this machine can come in, unless --host says otherwise; then visitors need the printed link, with its token.
    """
    from tarsus.studio.server.serve import Serving
    from tarsus.studio.server.settings import Settings, is_loopback

    if public and token is not None:
        raise click.UsageError("--public lets anybody in, --token only those who know it: give one of them")
    if token is None and not public and not is_loopback(host):
        token = Settings.new_token()
    # A check must not fail because a studio is running.
    wanted = port if port is not None else 0 if check else _PORT
    settings = Settings(host=host, port=wanted, public=public, token=token, start=_start(robot))
    serving = Serving(settings)
    if check:
        return _check(serving, as_json=as_json)
    _tell(serving, as_json=as_json)
    if not no_browser and sys.stdout.isatty():
        click.launch(serving.url)
    serving.run()
    return 0


def _start(robot: str) -> StudioState:
    from tarsus.robot.file import load_robot
    from tarsus.studio.messages.state import StudioState
    from tarsus.studio.robots import choice_of_document, robot_of

    choice = choice_of_document(load_robot(robot).to_dict())
    robot_of(choice)
    return StudioState(robot=choice)


def _tell(serving: Serving, *, as_json: bool) -> None:
    if as_json:
        print_json({"url": serving.url})
        return
    click.echo(f"Tarsus Studio: {serving.url}")
    click.echo("Ctrl-C ends it.")


def _check(serving: Serving, *, as_json: bool) -> int:
    with serving:
        health = serving.health()
    if as_json:
        print_json({"url": serving.url, **health})
    else:
        pages = "and has its pages" if health["pages"] else "but its pages are not built: run `make web`"
        click.echo(f"the studio answers at {serving.url} {pages}")
    return 0 if health["status"] == "ok" else 1
