"""The server on a free port, as a browser uses it."""

from __future__ import annotations

import asyncio
import contextlib
import gzip
import http.client
import ipaddress
import itertools
import json
import re
import socket
import time
from urllib.parse import urlsplit

import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import connect

from tarsus import InputError, load_robot
from tarsus.robot.file import robot_to_dict
from tarsus.studio.messages import CLOSED, SOCKET
from tarsus.studio.messages.state import RobotChoice, StudioState
from tarsus.studio.server import serve
from tarsus.studio.server.access import HEADERS
from tarsus.studio.server.pages import Pages
from tarsus.studio.server.serve import Serving
from tarsus.studio.server.settings import Limits, Settings, is_loopback

SCRIPT = "console.log('studio');" * 200


@pytest.fixture(scope="module")
def pages(tmp_path_factory):
    folder = tmp_path_factory.mktemp("web")
    (folder / "assets").mkdir()
    (folder / "index.html").write_text("<!doctype html><title>Studio</title>", encoding="utf-8")
    (folder / "assets" / "index-abc.js").write_text(SCRIPT, encoding="utf-8")
    (folder / "player.html").write_text("player", encoding="utf-8")
    (folder / "icon.svg").write_text("<svg/>", encoding="utf-8")
    return Pages(folder)


@pytest.fixture(scope="module")
def serving(pages):
    with Serving(Settings(), pages=pages) as server:
        yield server


@contextlib.contextmanager
def served(pages=None, **settings):
    with Serving(Settings(**settings), pages=pages) as server:
        yield server


def get(server, path="/", **headers):
    connection = http.client.HTTPConnection("127.0.0.1", server.settings.port, timeout=20)
    connection.request("GET", path, headers={key.replace("_", "-"): value for key, value in headers.items()})
    answer = connection.getresponse()
    answer.content = answer.read()
    connection.close()
    return answer


class Visit:
    """A visitor's socket."""

    def __init__(self, server, *, origin="", path=SOCKET, **more):
        here = f"127.0.0.1:{server.settings.port}"
        origin = f"http://{here}" if origin == "" else origin
        self.opened = contextlib.ExitStack()
        self.socket = self.opened.enter_context(
            connect(f"ws://{here}{path}", origin=origin, max_size=None, compression=None, **more)
        )
        self.count = 0

    def __enter__(self):
        return self

    def __exit__(self, *error):
        self.opened.close()

    def send(self, kind, **more):
        self.count += 1
        self.socket.send(json.dumps({"type": kind, "id": self.count, **more}))
        return self.count

    def receive(self):
        return json.loads(self.socket.recv(timeout=20))

    def ask(self, kind, **more):
        number, answers = self.send(kind, **more), []
        while not answers or answers[-1]["type"] != "done" or answers[-1]["id"] != number:
            answers.append(self.receive())
        return answers

    def rest(self):
        """What comes until the server closes the socket, and the code with which it does."""
        answers = []
        try:
            while True:
                answers.append(self.receive())
        except ConnectionClosed as end:
            return answers, end.rcvd.code

    def closed(self):
        """The code with which the server closes the socket."""
        return self.rest()[1]


def test_a_visitor_gets_a_session(serving):
    with Visit(serving) as visit:
        answers = visit.ask("hello")
        assert [answer["type"] for answer in answers] == ["welcome", "robot", "state", "walk", "done"]
        assert answers[0]["bounds"]["message_bytes"] == Limits().message_bytes
        assert visit.ask("joints", joints={"angles_deg": [0, 30, -90] * 6})[0]["contacts"] == "111111"


def test_sessions_are_independent(serving):
    with Visit(serving) as one, Visit(serving) as other:
        assert one.ask("robot", preset="phantomx")[0]["name"] == "phantomx"
        assert other.ask("hello")[1]["name"] == "strider"
        assert get_health(serving)["sessions"] == 2
    wait_for(lambda: get_health(serving)["sessions"] == 0)


def get_health(server):
    return json.loads(get(server, "/health").content)


def wait_for(reached, seconds=20):
    end = time.monotonic() + seconds
    while not reached():
        assert time.monotonic() < end
        time.sleep(0.02)


def test_a_state_is_restored_after_a_lost_connection(serving):
    with Visit(serving) as visit:
        visit.ask("robot", preset="phantomx")
        text = visit.ask("body", body={"x_mm": 12})[-1]["state"]
        visit.socket.socket.shutdown(socket.SHUT_RDWR)
    with Visit(serving) as again:
        answers = again.ask("hello", state=text)
        assert answers[1]["name"] == "phantomx"
        assert answers[2]["state"]["body"]["x_mm"] == 12


def test_driving_sends_frames_until_it_is_stopped(serving):
    with Visit(serving) as visit:
        number = visit.send("drive", on=True)
        visit.send("command", velocity_mm_s=[60, 0], turn_deg_s=5)
        frames = []
        while len(frames) < 60:
            answer = visit.receive()
            if answer["type"] == "frame":
                frames.append(answer)
        assert {frame["id"] for frame in frames} == {number}
        times = [frame["time_s"] for frame in frames]
        assert all(after > before for before, after in itertools.pairwise(times))
        assert frames[-1]["state"] == "walking"
        assert frames[-1]["position_mm"][0] > frames[0]["position_mm"][0]
        refused = visit.ask("command", velocity_mm_s=[0, 0], turn_deg_s=0, gait="gallop")
        assert any(answer["type"] == "error" and answer["kind"] == "unknown_name" for answer in refused)
        visit.ask("drive", on=False)
        assert [answer["type"] for answer in visit.ask("ping")] == ["done"]


@pytest.mark.parametrize("origin", ["http://evil.example", "https://127.0.0.1", "null", "http://127.0.0.1:1"])
def test_pages_of_other_origins_cannot_connect(serving, origin):
    with pytest.raises(InvalidStatus) as refused:
        Visit(serving, origin=origin)
    assert refused.value.response.status_code == 403
    assert get_health(serving)["status"] == "ok"


def test_other_host_names_are_rejected(serving):
    """A page may have its own name resolve to this machine: then origin and host agree, and neither is ours."""
    assert get(serving, host="evil.example:80").status == 403
    with pytest.raises(InvalidStatus) as refused:
        Visit(serving, origin="http://evil.example", additional_headers={"host": "evil.example"})
    assert refused.value.response.status_code in (400, 403)
    assert get(serving, host=f"localhost:{serving.settings.port}").status == 200
    assert get(serving, host="[::1]").status == 200
    assert get(serving, host="[nonsense").status == 403


def test_clients_without_an_origin_can_connect(serving):
    with Visit(serving, origin=None) as visit:
        assert visit.ask("ping")[-1]["type"] == "done"


def test_a_token_is_required_to_connect(pages):
    with served(pages, token="open-sesame") as server:
        assert server.url.endswith("/?token=open-sesame")
        assert get(server).status == 401
        assert get(server, "/assets/index-abc.js").status == 401
        assert get(server, "/?token=wrong").status == 401
        assert get(server, "/health").status == 200
        answer = get(server, "/?token=open-sesame")
        assert (answer.status, answer.headers["location"]) == (303, "/")
        cookie = answer.headers["set-cookie"]
        assert "HttpOnly" in cookie
        assert "SameSite=Lax" in cookie
        cookie = cookie.partition(";")[0]
        assert get(server, cookie=cookie).status == 200
        assert get(server, cookie=cookie.replace("open", "wrong")).status == 401
        with Visit(server, additional_headers={"cookie": cookie}) as visit:
            assert visit.ask("ping")[-1]["type"] == "done"
        with Visit(server, path=f"{SOCKET}?token=open-sesame") as visit:
            assert visit.ask("ping")[-1]["type"] == "done"
        for way in ({}, {"path": f"{SOCKET}?token=wrong"}, {"additional_headers": {"cookie": "nonsense=;;=;"}}):
            with Visit(server, **way) as visit:
                assert visit.closed() == CLOSED["TOKEN"][0] == 4401


def test_a_message_too_large_ends_only_its_session():
    with served(limits=Limits(message_bytes=5000)) as server, Visit(server) as other:
        with Visit(server) as visit:
            visit.socket.send("x" * 6000)
            assert visit.closed() == CLOSED["LARGE"][0]
        assert other.ask("ping")[-1]["type"] == "done"


def test_too_many_malformed_messages_end_the_session():
    with served(limits=Limits(malformed=5)) as server, Visit(server) as visit:
        for text in ("nonsense", b"\xff\x00", "{}", '{"type": "joints", "id": 9}', "[" * 1000):
            visit.socket.send(text)
            error, done = visit.receive(), visit.receive()
            assert (error["type"], error["kind"], done["type"]) == ("error", "message", "done")
        assert visit.ask("ping")[-1]["type"] == "done"
        for _ in range(6):
            visit.socket.send("nonsense")
        assert visit.closed() == CLOSED["RATE"][0]


def test_excess_messages_are_rejected_and_then_end_the_session():
    with served(limits=Limits(messages_per_s=10, malformed=20)) as server, Visit(server) as visit:
        with contextlib.suppress(ConnectionClosed):
            for _ in range(60):
                visit.send("ping")
        answers, code = visit.rest()
        assert "limit" in {answer.get("kind") for answer in answers}
        assert code == CLOSED["RATE"][0]


def test_the_number_of_queued_messages_is_limited():
    with served(limits=Limits(waiting=3)) as server, Visit(server) as visit:
        busy = visit.send("servos")
        for _ in range(10):
            visit.send("undo")
        answers = []
        while not answers or answers[-1].get("id") != busy or answers[-1]["type"] != "done":
            answers.append(visit.receive())
        refused = [answer for answer in answers if answer.get("kind") == "limit"]
        assert len(refused) >= 6
        assert "3 messages are queued" in refused[0]["text"]


def test_the_number_of_sessions_is_limited():
    with served(limits=Limits(sessions=2)) as server, Visit(server) as one, Visit(server):
        with Visit(server) as third:
            assert third.closed() == CLOSED["FULL"][0]
        one.socket.close()
        wait_for(lambda: get_health(server)["sessions"] < 2)
        with Visit(server) as another:
            assert another.ask("ping")[-1]["type"] == "done"


def test_an_idle_session_ends():
    limits = Limits(idle_s=0.2)
    assert limits.bounds.idle_s == 0.2
    with served(limits=limits) as server, Visit(server) as visit:
        assert visit.closed() == CLOSED["IDLE"][0]


def test_of_queued_messages_the_newest_is_processed(serving):
    with Visit(serving) as visit:
        visit.send("servos")  # which takes a while
        last = [visit.send("body", body={"x_mm": x}, commit=False) for x in range(60)][-1]
        answered, dropped, pose = set(), 0, None
        while last not in answered:
            answer = visit.receive()
            if answer["type"] == "done":
                answered.add(answer["id"])
                dropped += answer["dropped"]
            elif answer["type"] == "pose":
                pose = answer
        assert len(answered) == 61
        assert dropped > 0
        assert pose["position_mm"][0] == 59


def test_sockets_of_other_versions_do_not_exist(serving):
    with pytest.raises(InvalidStatus) as refused:
        Visit(serving, path="/session/0")
    assert refused.value.response.status_code == 403


def test_the_health_check_reports_ok(serving):
    health = get_health(serving)
    assert (health["status"], health["pages"]) == ("ok", True)
    assert serving.health() == health


@pytest.mark.parametrize(
    ("path", "kind"),
    [
        ("/", "text/html"),
        ("/index.html", "text/html"),
        ("/assets/index-abc.js", "text/javascript"),
        ("/icon.svg", "image/svg+xml"),
    ],
)
def test_pages_have_security_headers(serving, path, kind):
    answer = get(serving, path)
    assert answer.status == 200
    assert answer.headers["content-type"].partition(";")[0] == kind
    for name, value in HEADERS.items():
        assert answer.headers[name] == value
    assert not re.search(r"https?:", answer.headers["content-security-policy"])
    assert "server" not in answer.headers
    again = get(serving, path, if_none_match=answer.headers["etag"])
    assert (again.status, again.content) == (304, b"")


def test_large_files_are_compressed(serving):
    packed = get(serving, "/assets/index-abc.js", accept_encoding="gzip")
    assert packed.headers["content-encoding"] == "gzip"
    assert gzip.decompress(packed.content).decode() == SCRIPT == get(serving, "/assets/index-abc.js").content.decode()
    assert "immutable" in packed.headers["cache-control"]
    assert get(serving).headers["cache-control"] == "no-cache"


@pytest.mark.parametrize(
    "path",
    [
        "/nothing",
        "/assets",
        "/assets/",
        "/../pyproject.toml",
        "/%2e%2e/pyproject.toml",
        "//etc/passwd",
        "/docs",
        "/openapi.json",
    ],
)
def test_other_paths_are_not_served(serving, path):
    answer = get(serving, path)
    assert answer.status == 404
    assert answer.content == b"no such file"


def test_missing_pages_are_reported_with_the_build_command(tmp_path):
    with served(Pages(tmp_path / "nothing")) as server:
        answer = get(server)
        assert answer.status == 503
        assert b"make web" in answer.content
        assert not get_health(server)["pages"]


def test_a_port_in_use_is_an_error(serving):
    port = serving.settings.port
    with pytest.raises(InputError, match=f"port {port} at 127.0.0.1 is in use; choose another"):
        Serving(Settings(port=port))


@pytest.mark.parametrize(("host", "words"), [("192.0.2.1", "cannot listen on"), ("no such host", "cannot listen on")])
def test_an_invalid_address_is_an_error(host, words):
    with pytest.raises(InputError, match=words):
        Serving(Settings(host=host))


@pytest.mark.parametrize(
    ("host", "own"),
    [
        ("127.0.0.1", True),
        ("127.1.2.3", True),
        ("localhost", True),
        ("::1", True),
        ("[::1]", True),
        ("0.0.0.0", False),
        ("192.168.0.5", False),
        ("evil.example", False),
        ("", False),
    ],
)
def test_loopback_addresses_are_recognised(host, own):
    assert is_loopback(host) is own


def test_the_printed_link_has_an_address_of_this_machine_rather_than_its_name(pages, monkeypatch):
    with served(pages, host="0.0.0.0", public=True) as server:
        host = urlsplit(server.url).hostname
        ipaddress.ip_address(host)
        with socket.socket() as probe:
            probe.bind((host, 0))  # only possible with an address of its own
        # Without a network there is no address but the loopback one.
        monkeypatch.setitem(serve._ELSEWHERE, socket.AF_INET, ("255.255.255.255", 9))
        assert urlsplit(server.url).hostname == "127.0.0.1"


def test_a_public_server_accepts_any_host_name(pages):
    with served(pages, host="0.0.0.0", public=True) as server:
        assert get(server, host="studio.example").status == 200
        with Visit(server, origin=None) as visit:
            assert visit.ask("hello")[0]["public"]
            assert visit.ask("robot", preset="/etc/passwd")[0]["kind"] == "unknown_name"


def test_a_session_starts_with_the_robot_of_the_command_line():
    robot = load_robot("strider").replace(name="mine")
    start = StudioState(robot=RobotChoice(preset=None, document=robot_to_dict(robot)))
    with served(start=start) as server, Visit(server) as visit:
        assert visit.ask("hello")[1]["name"] == "mine"


def test_the_server_stops_with_open_sessions():
    with contextlib.ExitStack() as visitors:
        with Serving(Settings()) as server:
            visit = visitors.enter_context(Visit(server))
            visit.send("drive", on=True)
            visit.receive()
        assert visit.closed() == 1012  # the server restarts, says the standard: come back later


def test_a_connection_that_comes_while_the_server_ends_is_closed():
    """One that is accepted after all others were asked to end, for example of a page that reconnects at once."""

    class Late:
        def __init__(self):
            self.ended = 0

        def shutdown(self):
            self.ended += 1
            server.server_state.connections.discard(self)

    with Serving(Settings()) as serving:
        assert serving.health()
        server, late = serving._server, Late()
        asked = server.shutdown

        async def shutdown(sockets=None):
            asyncio.get_running_loop().call_later(0.01, server.server_state.connections.add, late)
            await asked(sockets)

        server.shutdown = shutdown
    assert late.ended == 1
