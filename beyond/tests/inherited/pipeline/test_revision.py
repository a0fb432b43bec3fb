"""The commit of a repository, and whether anything has changed since."""

import shutil
import subprocess

import pytest

from bouncing_ball_beyond.inherited.pipeline import provenance as module
from bouncing_ball_beyond.inherited.pipeline.provenance import UNKNOWN, house_of, revision


@pytest.fixture
def repository(tmp_path, monkeypatch):
    """A repository with a source, a record and an ignored folder, all committed."""
    for name in ("AUTHOR", "COMMITTER"):
        monkeypatch.setenv(f"GIT_{name}_NAME", "tests")
        monkeypatch.setenv(f"GIT_{name}_EMAIL", "tests")
    monkeypatch.setenv("GIT_CONFIG_GLOBAL", "/dev/null")
    monkeypatch.setenv("GIT_CONFIG_NOSYSTEM", "1")
    top = tmp_path / "top"
    house = ("Snakefile", "config/config.yaml", "figures/fig01.png", "paper.md")
    files = (*house, *(f"beyond/{file}" for file in house), "src/bouncing_ball/a.py")
    for file in files:
        (top / file).parent.mkdir(parents=True, exist_ok=True)
        (top / file).write_text("old", encoding="utf-8")
    (top / ".gitignore").write_text("results/\n", encoding="utf-8")
    for command in (["init", "--quiet"], ["add", "."], ["commit", "--quiet", "-m", "first"]):
        subprocess.run(["git", *command], cwd=top, check=True)
    return top


def head(folder):
    return subprocess.check_output(["git", "rev-parse", "HEAD"], cwd=folder, text=True).strip()


@pytest.mark.parametrize(
    ("file", "dirty"),
    [
        (".git/new", "no"),
        ("src/bouncing_ball/a.py", "yes"),
        # A new module counts, what git ignores and the record itself do not.
        ("src/bouncing_ball/b.py", "yes"),
        ("results/fig01.png", "no"),
        ("figures/fig01.png", "no"),
        ("figures/fig99.png", "no"),
        ("paper.md", "no"),
        ("README.md", "yes"),
        ("docs/record.md", "yes"),
    ],
)
def test_a_tree_is_dirty_by_sources_and_not_by_results_or_the_record(repository, file, dirty):
    (repository / file).parent.mkdir(exist_ok=True)
    (repository / file).write_text("new", encoding="utf-8")
    assert revision(repository) == (head(repository), dirty)


@pytest.mark.parametrize(
    ("file", "dirty"),
    [
        ("beyond/figures/fig01.png", "no"),
        ("beyond/paper.md", "no"),
        # Also the record of the other house, whose code is not that of the results.
        ("figures/fig01.png", "no"),
        ("paper.md", "no"),
        ("beyond/config/config.yaml", "yes"),
        ("src/bouncing_ball/a.py", "yes"),
    ],
)
def test_a_house_in_the_checkout_has_its_revision(repository, monkeypatch, file, dirty):
    monkeypatch.setattr(module, "REPOSITORY", repository)
    (repository / file).write_text("new", encoding="utf-8")
    assert revision(repository / "beyond") == (head(repository), dirty)


def test_a_hook_of_another_repository_does_not_mislead(repository, tmp_path, monkeypatch):
    expected = head(repository)
    monkeypatch.setenv("GIT_DIR", str(tmp_path / "elsewhere"))
    assert revision(repository) == (expected, "no")


def test_the_commit_is_unknown_without_a_repository_at_this_folder(
    repository, tmp_path, monkeypatch
):
    # A tarball unpacked inside of somebody's repository is not that commit.
    assert revision(repository / "src") == UNKNOWN
    assert revision(tmp_path) == UNKNOWN
    assert revision(tmp_path / "nowhere") == UNKNOWN
    shutil.rmtree(repository / ".git")
    subprocess.run(["git", "init", "--quiet"], cwd=repository, check=True)
    assert revision(repository) == UNKNOWN
    monkeypatch.setenv("PATH", str(tmp_path))
    assert revision(repository) == UNKNOWN


def test_an_archive_of_a_commit_names_it(repository, tmp_path):
    (repository / ".gitattributes").write_text(".git_archival.txt export-subst\n", "utf-8")
    (repository / ".git_archival.txt").write_text("node: $Format:%H$\n", "utf-8")
    subprocess.run(["git", "add", "."], cwd=repository, check=True)
    subprocess.run(["git", "commit", "--quiet", "-m", "second"], cwd=repository, check=True)
    unpacked = tmp_path / "unpacked"
    archive = subprocess.run(["git", "archive", "HEAD"], cwd=repository, capture_output=True)
    unpacked.mkdir()
    subprocess.run(["tar", "-x"], cwd=unpacked, input=archive.stdout, check=True)
    assert revision(unpacked) == (head(repository), "unknown")
    # A copy of the files of a clone is no archive.
    shutil.rmtree(repository / ".git")
    assert revision(repository) == UNKNOWN


def test_a_house_is_found_from_a_folder_inside_of_it(repository, tmp_path):
    assert house_of(repository / "src" / "bouncing_ball") == repository
    assert house_of(repository / "beyond" / "figures") == repository / "beyond"
    assert house_of(tmp_path, repository) == repository
    assert house_of(tmp_path) is None
