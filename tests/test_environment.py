"""environment.sh: a changed environment is mended or refused; no file of others is removed."""

import shutil
import subprocess

import pytest
from tests.checkout import ROOT

PACKAGES = ".venv/lib/python3.11/site-packages"
INSTALL = "install", ".venv", ".installed", "requirements.lock", "--", "."
NOTED = f"{PACKAGES}/numpy-2.0.dist-info"
AGAIN = "Remove it (rm -r .venv), and give the same command again, which downloads its packages.\n"
ANOTHER = "Name another folder: make VENV=FOLDER\n"
# Stubs: `-m venv`, and a Python whose pip notes its arguments, and installs numpy of the lock file.
VENV = """mkdir -p "$3/bin" "$3/lib/python3.11/site-packages" && cp python .venv/bin/python"""
PYTHON = """#!/bin/sh
case "$*" in
*version_info*) echo python3.11 ;;
*"pip "*)
    echo "$*" >> pip.log
    sh ./pip || exit
    mkdir -p .venv/lib/python3.11/site-packages/"$(sed s/==/-/ requirements.lock)".dist-info ;;
esac
"""


@pytest.fixture
def house(tmp_path):
    """A package whose environment was installed, with stubs of Python, of pip and of python.sh."""
    for name in "environment.sh", "pyproject.toml":
        shutil.copyfile(ROOT / name, tmp_path / name)
    (tmp_path / "requirements.lock").write_text("numpy==2.0\n")
    (tmp_path / "python.sh").write_text(f'[ "$1" = --builds ] || {{ {VENV}; }}\n')
    (tmp_path / "python").write_text(PYTHON)
    (tmp_path / "python").chmod(0o755)
    (tmp_path / "pip").touch()
    status, said, refused = run(tmp_path, *INSTALL)
    assert (status, refused) == (0, "")
    assert said == "Installing into .venv, in about a minute.\n"
    return tmp_path


def run(house, *arguments):
    """The status of environment.sh, what it prints, and the line with which it fails."""
    done = subprocess.run(
        ["sh", "environment.sh", *arguments], cwd=house, capture_output=True, text=True
    )
    return done.returncode, done.stdout, done.stderr


MENDED = {
    "": "",
    f"mkdir {PACKAGES}/ipython-9.0.dist-info": "",
    f"mv {NOTED} x": ".venv no longer has numpy-2.0: installing what differs.\n",
    "echo numpy==2.2 > requirements.lock": (
        ".venv was installed from another requirements.lock: installing what differs.\n"
    ),
    "rm -r .venv": "Installing into .venv, in about a minute.\n",
    "rm -r .venv; mkdir .venv": "Installing into .venv, in about a minute.\n",
}


@pytest.mark.parametrize("change", MENDED)
def test_what_differs_is_installed_and_nothing_else(house, change):
    (house / PACKAGES / "notes.txt").touch()
    subprocess.run(change, cwd=house, shell=True, check=True)
    (house / "pip.log").write_text("")
    kept = (house / PACKAGES / "notes.txt").exists()
    assert run(house, *INSTALL) == (0, MENDED[change], "")
    assert (house / PACKAGES / "notes.txt").exists() == kept
    log = (house / "pip.log").read_text()
    assert ("--requirement requirements.lock" in log) == bool(MENDED[change])
    assert ("--editable ." in log) == bool(MENDED[change])
    assert run(house, *INSTALL) == (0, "", "")
    assert (house / "pip.log").read_text() == log


def test_the_tools_of_developers_are_asked_for_by_those_who_need_them(house):
    develop = "install", ".venv", ".developing", "requirements.lock"
    assert run(house, *develop)[0] == 0
    (house / NOTED).rename(house / "x")
    (house / "pip").write_text("exit 1\n")
    assert run(house, *develop)[0] == 1


REFUSED = {
    "mv .venv/lib/python3.11 .venv/lib/python3.10": f"its Python is now python3.11. {AGAIN}",
    "ln -sf /nowhere .venv/bin/python": f"has a Python that does not run. {AGAIN}",
    "rm .venv/.installed": f"was not installed to its end. {AGAIN}",
    "touch .venv/.installing": f"was not installed to its end. {AGAIN}",
    "rm .venv/.package": f"was installed before make noted what it installs. {AGAIN}",
    "rm -r .venv; ln -s y .venv": "which does not exist. Remove the link (rm .venv),",
    "rm -r .venv; touch .venv": "is not a folder. Name another one: make VENV=FOLDER\n",
    "rm .venv/.package .venv/.installed": f"has files that make did not install. {ANOTHER}",
    "echo x > .venv/.package": f"is the environment of x, not of bouncing-ball. {ANOTHER}",
}


@pytest.mark.parametrize("change", REFUSED)
def test_one_line_says_what_cannot_be_mended_and_what_cures_it(house, change):
    subprocess.run(change, cwd=house, shell=True, check=True)
    before = {*house.rglob("*")}
    status, said, refused = run(house, *INSTALL)
    assert (status, said, refused.count("\n")) == (1, "", 1)
    assert REFUSED[change] in refused
    assert {*house.rglob("*")} == before


def test_a_pip_that_fails_leaves_a_whole_environment_and_one_that_is_killed_does_not(house):
    lock = house / "requirements.lock"
    for pip, message in [("exit 1", ""), ("kill -9 $$", "was not installed to its end")]:
        (house / "pip").write_text(f"{pip}\n")
        lock.write_text("numpy==2.2\n")
        assert run(house, *INSTALL)[0] == 1
        lock.write_text("numpy==2.0\n")
        status, _, refused = run(house, *INSTALL)
        assert status == bool(message)
        assert message in refused


@pytest.mark.parametrize(
    "change", ["rm .venv/.package", "rm .venv/.package .venv/.installed", "echo x > .venv/.package"]
)
def test_only_an_environment_of_this_package_is_begun_again(house, change):
    (house / ".venv/notes.txt").touch()
    subprocess.run(change, cwd=house, shell=True, check=True)
    assert run(house, "new", ".venv")[0] == 1
    assert (house / ".venv/notes.txt").exists()
    (house / ".venv/.package").write_text("bouncing-ball\n")
    assert run(house, "new", ".venv") == (0, "", "")
    assert {path.name for path in (house / ".venv").iterdir()} == {".package", "bin", "lib"}
    # It was not installed to its end.
    assert run(house, *INSTALL)[0] == 1


def test_the_makefiles_install_before_anything_else_and_take_no_folder_from_the_shell(tmp_path):
    for folder in (ROOT, ROOT / "extras/beyond", ROOT / "extras/contacts"):
        shell = {"VENV": str(tmp_path), "PATH": "/usr/bin:/bin"}
        for arguments, named in [([], ".venv"), ([f"VENV={tmp_path}"], str(tmp_path))]:
            command = ["make", "--dry-run", "--always-make", "-C", str(folder), *arguments]
            printed = subprocess.check_output(command, env=shell, text=True)
            first = next(line for line in printed.splitlines() if not line.startswith("make"))
            assert f"environment.sh install {named} .installed " in first
