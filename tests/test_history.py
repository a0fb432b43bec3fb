"""Git is asked about one folder, whatever the environment says (see conftest), and hurts nobody."""

import shutil

import pytest
from tests.repository import commit, git

from bouncing_ball import history
from bouncing_ball.history import History


@pytest.fixture(scope="module")
def original(tmp_path_factory):
    folder = tmp_path_factory.mktemp("original")
    git(folder, "init", "-q")
    (folder / "src").mkdir()
    for name in ("one.py", "two.py", "three [1].py"):
        (folder / "src" / name).write_text("one\n")
    commit(folder, "first")
    return folder


@pytest.fixture
def checkout(original, tmp_path):
    """A git checkout with some committed files."""
    folder = tmp_path / "ünï {x} 你好"
    shutil.copytree(original, folder)
    return folder


def test_a_commit_is_dirty_if_one_of_the_files_has_changed(checkout):
    head = git(checkout, "rev-parse", "HEAD")
    code = checkout / "src" / "one.py"
    (checkout / "src" / "two.py").write_text("two\n")
    (checkout / "src" / "new.py").write_text("new\n")
    assert history.commit([code], checkout) == head
    code.write_text("two\n")
    assert history.commit([code], checkout) == head + "+dirty"
    assert history.commit([checkout / "src" / "new.py"], checkout) == head + "+dirty"


def test_an_archive_names_its_commit(checkout):
    (checkout / ".git_archival.txt").write_text(f"node: {'a1' * 20}\n")
    assert history.commit([], checkout) == "a1" * 20 + " (archive)"


def test_no_commit_is_known_without_git_or_in_a_checkout_of_another_owner(
    checkout, tmp_path, monkeypatch
):
    assert history.commit([], tmp_path) == "unknown"
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    assert history.commit([], checkout) == "unknown (git: dubious ownership)"
    monkeypatch.setenv("PATH", "")
    assert history.commit([], checkout) == "unknown"


def test_an_owner_that_the_user_declares_safe_is_known(checkout, monkeypatch):
    monkeypatch.setenv("GIT_TEST_ASSUME_DIFFERENT_OWNER", "1")
    monkeypatch.setenv("GIT_CONFIG_COUNT", "1")
    monkeypatch.setenv("GIT_CONFIG_KEY_0", "safe.directory")
    monkeypatch.setenv("GIT_CONFIG_VALUE_0", str(checkout))
    assert len(history.commit([], checkout)) == 40


def test_a_folder_inside_another_repository_has_no_history(checkout):
    """As an archive that was unpacked there."""
    inside = History(checkout / "src")
    assert inside.head == "" and inside.uncommitted([checkout / "src" / "one.py"]) == set()
    assert history.commit([], checkout / "src") == "unknown"


def test_a_linked_worktree_is_a_checkout(checkout, tmp_path):
    git(checkout, "worktree", "add", "-q", "-b", "feature", str(tmp_path / "linked"))
    (tmp_path / "linked/src/one.py").write_text("two\n")
    assert History(tmp_path / "linked").uncommitted([tmp_path / "linked/src"]) == {"src/one.py"}
    assert History(checkout).uncommitted([checkout / "src"]) == set()


def test_files_are_told_with_when_they_changed_the_latest_first(checkout):
    def change(name):
        (checkout / "src" / name).write_text("changed\n")
        return commit(checkout, name)[:7]

    first = History(checkout).head
    pushed = change("one.py")
    git(checkout, "checkout", "-q", "-b", "feature")
    committed = change("two.py")
    (checkout / "src/three [1].py").write_text("three\n")
    known = History(checkout)
    assert known.since(first, [checkout / "src"]) == ["src/one.py", "src/two.py"]
    told = known.told(["src/one.py", "src/two.py", "src/three [1].py"])
    assert told[0] == "src/three [1].py (not committed)"
    assert {*told[1:]} == {
        f"src/two.py (on this branch, {committed})",
        f"src/one.py ({pushed})",
    }


def test_what_is_no_commit_is_no_argument(checkout, tmp_path):
    target = tmp_path / "overwritten"
    known = History(checkout)
    for text in (f"--output={target}", "main", "HEAD~1", "", "0" * 39):
        assert known.since(text, [checkout / "src"]) is None
        assert known.newest([text], [checkout / "src"]) == known.head
    assert known.since("0" * 40, [checkout / "src"]) is None
    assert not target.exists()


def test_a_shallow_clone_does_not_know_when_files_changed(checkout, tmp_path):
    commit(checkout, "second")
    clone = tmp_path / "clone"
    git(checkout, "clone", "-q", "--depth", "1", f"file://{checkout}", str(clone))
    known = History(clone)
    assert known.head and known.newest([], [clone / "src"]) == ""
    assert known.told(["src/one.py"]) == ["src/one.py"]
