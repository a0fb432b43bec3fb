"""Git in repositories of the tests' own."""

from pathlib import Path

from bouncing_ball import history

SETTINGS = {
    "user.name": "A",
    "user.email": "a@b.c",
    "init.defaultBranch": "main",
    "commit.gpgSign": "false",
    "core.hooksPath": "/dev/null",
    "init.templateDir": "",
}


def git(folder: Path, *arguments: str) -> str:
    """What git answers in a folder, which must be a repository itself: no test may change another
    one.
    """
    assert arguments[0] == "init" or (folder / ".git").exists()
    settings = [word for key, value in SETTINGS.items() for word in ("-c", f"{key}={value}")]
    command = [*settings, *arguments]
    answer = history.git(folder, *command)
    assert answer.returncode == 0, answer.stderr
    return answer.stdout.strip()


def commit(folder: Path, message: str) -> str:
    """Commit everything in a folder; returns the commit."""
    git(folder, "add", "--all")
    git(folder, "commit", "-q", "--allow-empty", "-m", message)
    return git(folder, "rev-parse", "HEAD")
