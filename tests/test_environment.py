"""environment.sh: an environment that changed is seen, and no file of somebody else is removed."""

import shutil
import subprocess

import pytest
from tests.checkout import ROOT

PACKAGES = ".venv/lib/python3.11/site-packages"
AGAIN = "Remove it (rm -r .venv), and give the same command again, which downloads its packages.\n"
ANOTHER = "Name another folder: make VENV=FOLDER\n"


@pytest.fixture
def house(tmp_path):
    """A package whose environment was installed, with stubs of Python and of python.sh."""
    for name in "environment.sh", "pyproject.toml":
        shutil.copyfile(ROOT / name, tmp_path / name)
    (tmp_path / "requirements.lock").write_text("numpy==2.0\n")
    (tmp_path / "python.sh").write_text('mkdir "$3/bin"\n')
    assert ask(tmp_path, "new", ".venv") == (0, "")
    (tmp_path / PACKAGES / "numpy-2.0.dist-info").mkdir(parents=True)
    (tmp_path / ".venv/bin/python").write_text("#!/bin/sh\necho python3.11\n")
    (tmp_path / ".venv/bin/python").chmod(0o755)
    assert ask(tmp_path, "note", ".venv/.installed", "requirements.lock") == (0, "")
    return tmp_path


def ask(house, *arguments):
    done = subprocess.run(
        ["sh", "environment.sh", *arguments], cwd=house, capture_output=True, text=True
    )
    assert done.stdout == ""
    return done.returncode, done.stderr


CHANGES = {
    "": "",
    "mkdir .venv/lib/python3.11/site-packages/ipython-9.0.dist-info": "",
    "rm -r .venv": "",
    "rm -r .venv; mkdir .venv": "",
    f"mv {PACKAGES}/numpy-2.0.dist-info x": f"no longer has numpy-2.0. {AGAIN}",
    "echo numpy==2.2 > requirements.lock": f"was installed from another requirements.lock. {AGAIN}",
    "mv .venv/lib/python3.11 .venv/lib/python3.10": f"its Python is now python3.11. {AGAIN}",
    "ln -sf /nowhere .venv/bin/python": f"has a Python that does not run. {AGAIN}",
    "rm .venv/.installed": f"was not installed to its end. {AGAIN}",
    "rm .venv/.package": f"was installed before make noted what it installs. {AGAIN}",
    "rm -r .venv; ln -s y .venv": "which does not exist. Remove the link (rm .venv),",
    "rm -r .venv; touch .venv": "is not a folder. Name another one: make VENV=FOLDER\n",
    "rm .venv/.package .venv/.installed": f"has files that make did not install. {ANOTHER}",
    "echo x > .venv/.package": f"is the environment of x, not of bouncing-ball. {ANOTHER}",
}


@pytest.mark.parametrize("change", CHANGES)
def test_one_line_says_what_changed_and_what_cures_it(house, change):
    subprocess.run(change, cwd=house, shell=True, check=True)
    before = {*house.rglob("*")}
    status, line = ask(house, "check", ".venv")
    assert (status, line.count("\n")) == ((1, 1) if CHANGES[change] else (0, 0))
    assert CHANGES[change] in line
    assert {*house.rglob("*")} == before


@pytest.mark.parametrize(
    "change", ["rm .venv/.package", "rm .venv/.package .venv/.installed", "echo x > .venv/.package"]
)
def test_only_an_environment_of_this_package_is_begun_again(house, change):
    (house / ".venv/notes.txt").touch()
    subprocess.run(change, cwd=house, shell=True, check=True)
    assert ask(house, "new", ".venv")[0] == 1
    assert (house / ".venv/notes.txt").exists()
    (house / ".venv/.package").write_text("bouncing-ball\n")
    assert ask(house, "new", ".venv") == (0, "")
    assert {path.name for path in (house / ".venv").iterdir()} == {".package", "bin"}
    # It was not installed to its end.
    assert ask(house, "check", ".venv")[0] == 1


def test_the_makefiles_ask_it_before_they_install_and_take_no_folder_from_the_shell(tmp_path):
    for folder in (ROOT, ROOT / "extras/beyond", ROOT / "extras/contacts"):
        shell = {"VENV": str(tmp_path), "PATH": "/usr/bin:/bin"}
        for arguments, named in [([], ".venv"), ([f"VENV={tmp_path}"], str(tmp_path))]:
            command = ["make", "--dry-run", "--always-make", "-C", str(folder), *arguments]
            printed = subprocess.check_output(command, env=shell, text=True)
            asked, made = (
                printed.index(f"environment.sh {each} {named}\n") for each in ("check", "new")
            )
            assert asked < made
