"""The README's example runs, and prints what the README says it prints."""

import contextlib
import io
import re
import tomllib
from pathlib import Path

ROOT = Path(__file__).parents[1]
README = (ROOT / "README.md").read_text(encoding="utf-8")


def blocks(language):
    return re.findall(rf"```{language}\n(.*?)```", README, flags=re.DOTALL)


def test_the_example_prints_what_the_readme_shows():
    (example,), (shown,) = blocks("python"), blocks("text")
    printed = io.StringIO()
    with contextlib.redirect_stdout(printed):
        exec(compile(example, "README.md", "exec"), {})
    assert printed.getvalue() == shown


def test_the_example_is_about_ten_lines():
    (example,) = blocks("python")
    assert len([line for line in example.splitlines() if line.strip()]) <= 10


def test_every_file_the_documents_point_to_is_there():
    for document in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]:
        links = re.findall(r"\]\(([^)#:]+)(?:#[^)]*)?\)", document.read_text(encoding="utf-8"))
        missing = [link for link in links if not (document.parent / link).exists()]
        assert not missing, f"{document.name} points to {missing}"


def headings(document):
    text = re.sub(r"```.*?```", "", document.read_text(encoding="utf-8"), flags=re.DOTALL)
    titles = re.findall(r"^#+ (.*)$", text, flags=re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", title.lower()).replace(" ", "-") for title in titles}


def test_every_heading_the_documents_point_to_is_there():
    for document in [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md")]:
        links = re.findall(r"\]\(([^)#:]*)#([^)]+)\)", document.read_text(encoding="utf-8"))
        pages = [(document.parent / page if page else document, heading) for page, heading in links]
        missing = [(page.name, heading) for page, heading in pages if heading not in headings(page)]
        assert not missing, f"{document.name} points to {missing}"


def test_every_make_target_the_documents_name_exists():
    makefile = (ROOT / "Makefile").read_text(encoding="utf-8")
    for document in [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]:
        for target in re.findall(r"^make (\w+)|`make (\w+)`", document.read_text(encoding="utf-8"), flags=re.MULTILINE):
            assert re.search(rf"^{''.join(target)}:", makefile, flags=re.MULTILINE), target


def test_every_command_the_readme_shows_parses():
    from click.testing import CliRunner

    from tarsus.cli import main

    shell = "\n".join(blocks("sh"))
    commands = re.findall(r"^tarsus (\w+)", shell, flags=re.MULTILINE)
    assert commands
    for command in commands:
        assert CliRunner().invoke(main, [command, "--help"]).exit_code == 0


def test_the_readme_writes_the_urdf_file_before_it_imports_it():
    shell = "\n".join(blocks("sh"))
    imported = re.search(r"^tarsus robots import (\S+)", shell, flags=re.MULTILINE)
    assert f" --out {imported[1]} " in shell[: imported.start()]


def test_the_documents_install_extras_that_exist_from_the_clone():
    extras = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]["optional-dependencies"]
    for document in [ROOT / "README.md", ROOT / "CONTRIBUTING.md", *(ROOT / "docs").glob("*.md")]:
        for target in re.findall(r"pip install '([^']*)'", document.read_text(encoding="utf-8")):
            assert re.fullmatch(r"\.\[[a-z,]+\]", target), f"{document.name}: {target} is not on an index"
            assert set(target[2:-1].split(",")) <= set(extras)
