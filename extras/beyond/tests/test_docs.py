"""The pages of docs: their examples, their links, and the names on the page of all functions."""

import ast
import doctest
import re
import runpy
import sys
import tomllib
from pathlib import Path

import matplotlib.pyplot as plt
import pytest

import bouncing_ball_beyond
from bouncing_ball_beyond.contacts import named_laws

BEYOND = Path(__file__).resolve().parents[1]
PAGES = sorted([*BEYOND.glob("*.md"), *(BEYOND / "docs").glob("*.md")])


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_examples(page, monkeypatch, tmp_path):
    plt.switch_backend("agg")
    monkeypatch.chdir(tmp_path)
    failed, _ = doctest.testfile(str(page), module_relative=False)
    plt.close("all")
    assert failed == 0


@pytest.mark.parametrize(
    "script", sorted((BEYOND / "docs/gallery").glob("*.py")), ids=lambda script: script.stem
)
def test_a_script_of_the_gallery_draws_its_picture(script, monkeypatch, tmp_path):
    plt.switch_backend("agg")
    monkeypatch.chdir(tmp_path)
    runpy.run_path(str(script))
    plt.close("all")
    drawn, shown = (
        plt.imread(file.with_suffix(".png")) for file in (tmp_path / script.name, script)
    )
    assert drawn.shape == shown.shape


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_links_lead_to_files(page):
    text = page.read_text(encoding="utf-8")
    links = re.findall(r"\]\(([^)#\s]+)[^)]*\)", text)
    files = [link for link in links if "://" not in link]
    assert [file for file in files if not (page.parent / file).exists()] == []


def imported(module):
    """The first names of the modules that a file imports, also within functions."""
    for node in ast.walk(ast.parse(module.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Import):
            yield from (alias.name.partition(".")[0] for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.module.partition(".")[0]


def test_the_installation_of_the_readme_has_what_all_modules_import():
    project = tomllib.loads((BEYOND / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    readme = (BEYOND / "README.md").read_text(encoding="utf-8")
    extras = re.search(r"^pip install .*beyond\[([\w,]+)\]", readme, re.MULTILINE)[1].split(",")
    optional = project["optional-dependencies"]
    needed = sum((optional[extra] for extra in extras), project["dependencies"])
    # The replication has several packages, and an extra for figures.
    root = BEYOND.parents[1]
    replication = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    assert "bouncing-ball[figures]" in needed
    needed += replication["optional-dependencies"]["figures"]
    installed = {re.match(r"[\w-]+", requirement)[0].replace("-", "_") for requirement in needed}
    installed |= {package.name for package in (root / "src").iterdir()}
    modules = (BEYOND / "src" / "bouncing_ball_beyond").rglob("*.py")
    names = {name for module in modules for name in imported(module)}
    assert names - sys.stdlib_module_names - {"bouncing_ball_beyond"} <= installed


def test_a_folder_of_the_library_imports_only_from_those_before_it():
    library = BEYOND / "src" / "bouncing_ball_beyond"
    folders = ("tables", "contacts", "motions", "periodic", "errors", "output")
    assert {module.parent.name for module in library.glob("*/*.py")} == {*folders}
    for i, folder in enumerate(folders):
        texts = [module.read_text(encoding="utf-8") for module in (library / folder).glob("*.py")]
        used = {
            name for text in texts for name in re.findall(r"^from \w+_beyond\.(\w+)", text, re.M)
        }
        assert used <= {*folders[: i + 1]}


def test_the_page_of_all_functions_has_every_public_name():
    text = (BEYOND / "docs" / "api.md").read_text(encoding="utf-8")
    listed = set(re.findall(r"auto(?:function|class|exception):: (\w+)", text))
    public = set(bouncing_ball_beyond.__all__)
    # The page has the laws with names as a module.
    assert public - vars(named_laws).keys() <= listed
    assert listed <= public
