"""`tarsus studio` and `tarsus walk --html` on the command line."""

import json
import re
import signal
import subprocess
import sys
import urllib.request
from pathlib import Path

import pytest

from sample_commands import run
from tarsus import Gait, TarsusError, load_robot, plan_walk, straight_path
from tarsus.robot.file import save_robot
from tarsus.studio import player
from tarsus.studio.player import player_data, player_page
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Settings

SCRIPT = Path(sys.executable).with_name("tarsus")


def test_a_check_starts_and_stops_the_server():
    result = run("studio", "phantomx", "--check", "--json")
    assert result.exit_code == 0
    answer = json.loads(result.stdout)
    assert answer["status"] == "ok"
    assert re.fullmatch(r"http://127\.0\.0\.1:\d+/", answer["url"])


@pytest.mark.parametrize(
    ("options", "token"),
    [
        (("--host", "0.0.0.0"), True),
        (("--host", "0.0.0.0", "--public"), False),
        (("--token", "my-own"), True),
        (("--host", "localhost"), False),
    ],
)
def test_remote_visitors_need_the_printed_link(options, token):
    result = run("studio", *options, "--check", "--json")
    assert result.exit_code == 0
    url = json.loads(result.stdout)["url"]
    assert ("?token=" in url) == token
    assert ("token=my-own" in url) == ("my-own" in options)


def test_a_token_is_random():
    urls = {json.loads(run("studio", "--host", "0.0.0.0", "--check", "--json").stdout)["url"][-20:] for _ in range(2)}
    assert len(urls) == 2


@pytest.mark.parametrize(
    ("options", "words", "code"),
    [
        (("--public", "--token", "x", "--check"), "exclude each other", 2),
        (("--port", "70000", "--check"), "70000", 2),
        (("--token", "not; a token", "--check"), "letters, digits", 2),
        (("--token", "", "--check"), "letters, digits", 2),
        (("--host", "192.0.2.1", "--check"), "cannot listen on", 2),
        (("phantom", "--check"), "Did you mean 'phantomx'", 1),
    ],
)
def test_invalid_options_are_reported(options, words, code):
    result = run("studio", *options)
    assert result.exit_code == code
    assert words in result.stderr


def test_a_port_in_use_is_reported():
    with Serving(Settings()) as serving:
        result = run("studio", "--port", str(serving.settings.port), "--no-browser")
    assert result.exit_code == 2
    assert f"port {serving.settings.port} at 127.0.0.1 is in use" in result.stderr


def test_the_studio_starts_with_a_robot_file(tmp_path):
    save_robot(load_robot("strider").replace(name="mine"), tmp_path / "mine.toml")
    assert run("studio", str(tmp_path / "mine.toml"), "--check").exit_code == 0


def test_it_runs_until_it_is_interrupted():
    command = [SCRIPT, "studio", "--port", "0", "--no-browser"]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            link = process.stdout.readline()
            url = re.fullmatch(r"Tarsus Studio: (http://\S+)\n", link)[1]
            assert process.stdout.readline() == "Press Ctrl-C to stop.\n"
            with urllib.request.urlopen(f"{url}health", timeout=20) as answer:
                assert json.load(answer)["status"] == "ok"
            process.send_signal(signal.SIGINT)
            _, complaint = process.communicate(timeout=30)
        finally:
            # Leaving the context waits for the process, also after a failed assertion.
            process.kill()
    assert process.returncode == 0
    assert complaint == ""


@pytest.fixture
def template(tmp_path, monkeypatch):
    folder = tmp_path / "web"
    folder.mkdir()
    page = '<!doctype html><script type="application/json" id="motion">__MOTION__</script>'
    (folder / "player.html").write_text(page, encoding="utf-8")
    monkeypatch.setattr(player, "WEB", folder)
    return folder


def held(page):
    return json.loads(re.search(r'id="motion">(.*)</script>', page, flags=re.DOTALL)[1])


def test_a_page_contains_the_walk(template, tmp_path):
    file = tmp_path / "walk.html"
    result = run("walk", "strider", "--gait", "ripple", "--distance", "200", "--html", str(file))
    assert result.exit_code == 0
    assert f"wrote {file}" in result.stdout
    data = held(file.read_text(encoding="utf-8"))
    motion = plan_walk(load_robot("strider"), Gait.named("ripple"), straight_path(0.2))
    assert data["walk"]["count"] == len(motion.time)
    assert data["robot"]["name"] == "strider"
    assert len(data["loads"]["torques_nm"]) == motion.angles.size
    assert str(file) in json.loads(run("walk", "strider", "--html", str(file), "--json").stdout)["files"][0]


def test_the_name_of_a_robot_is_escaped(template):
    name = "</script><script>alert(1)</script>"
    robot = load_robot("mithi").replace(name=name)
    page = player_page(player_data(plan_walk(robot, Gait.named("tripod"), straight_path(0.2))))
    assert page.count("</script>") == 1
    assert held(page)["robot"]["name"] == name
    assert held(page)["loads"] is None


def test_an_unwritable_page_is_reported(template, tmp_path):
    result = run("walk", "strider", "--html", str(tmp_path / "no folder" / "walk.html"))
    assert result.exit_code == 2
    assert "can't be written" in result.stderr


def test_a_walk_too_long_for_a_page_is_rejected(template, tmp_path):
    result = run("walk", "strider", "--rate", "3000", "--html", str(tmp_path / "walk.html"))
    assert result.exit_code == 2
    assert "at most 10000" in result.stderr


def test_a_missing_player_is_reported_with_the_build_command(monkeypatch, tmp_path):
    monkeypatch.setattr(player, "WEB", tmp_path)
    motion = plan_walk(load_robot("mithi"), Gait.named("tripod"), straight_path(0.2))
    with pytest.raises(TarsusError, match="make web"):
        player_page(player_data(motion))
    (tmp_path / "player.html").write_text("<p>another page", encoding="utf-8")
    with pytest.raises(TarsusError, match="make web"):
        player_page(player_data(motion))
