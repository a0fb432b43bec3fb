"""python.sh: which Python the Makefiles take. .ci/wheels checks its list of builds."""

import os
import shutil
import subprocess
import tomllib

import pytest
import yaml
from tests.checkout import ROOT

PYTHON = """#!/bin/sh
case "$*" in
*version_info*) echo python{version} ;;
*ensurepip*) {venv} ;;
*CC*) echo {compiler} ;;
*include*) echo /usr/include ;;
*) echo "$0 $*" ;;
esac
"""


@pytest.fixture
def run(tmp_path):
    """Run python.sh with stubs of Python: version, command instead of venv, compiler."""
    (tmp_path / "pyproject.toml").write_text((ROOT / "pyproject.toml").read_text("utf-8"), "utf-8")

    def start(pythons, locked="immutables", **variables):
        (tmp_path / "requirements.lock").write_text(f"{locked}==1.0 \\\n")
        for name, (version, venv, compiler) in pythons.items():
            script = PYTHON.format(version=version, venv=venv, compiler=compiler)
            (tmp_path / name).write_text(script)
            (tmp_path / name).chmod(0o755)
        for tool in "sed", "seq", "grep", "sh":
            (tmp_path / tool).symlink_to(shutil.which(tool))
        done = subprocess.run(
            [ROOT / "python.sh", "-m", "venv"],
            cwd=tmp_path,
            env={"PATH": str(tmp_path), **variables},
            capture_output=True,
            text=True,
        )
        return done.returncode, done.stdout.replace(f"{tmp_path}/", ""), done.stderr

    return start


@pytest.mark.parametrize(
    ("pythons", "locked", "words"),
    [
        ({}, "immutables", "python3 is missing: install Python 3.11 to 3.14,"),
        ({"python3": ("3.10", "true", "true")}, "numpy", "python3 is 3.10: install"),
        ({"python3": ("3.15", "true", "true")}, "numpy", "python3 is 3.15: install"),
        ({"python3": ("3.13", "false", "false")}, "immutables", "call python3.13-venv: install"),
        ({"python3": ("3.14", "true", "false")}, "immutables", "call gcc python3.14-dev: install"),
        (
            {"python3": ("3.14", "false", "false")},
            "immutables",
            "call python3.14-venv gcc python3.14-dev: install",
        ),
    ],
)
def test_one_line_says_what_is_missing(run, pythons, locked, words):
    status, out, err = run(pythons, locked)
    assert (status, out, err.count("\n")) == (1, "", 1)
    assert words in err


@pytest.mark.parametrize(
    ("version", "compiler", "locked"),
    [("3.11", "false", "immutables"), ("3.14", "true", "immutables"), ("3.14", "false", "numpy")],
)
def test_a_python_that_serves_is_taken_silently(run, version, compiler, locked):
    python = {"python3": (version, "true", compiler)}
    assert run(python, locked) == (0, "python3 -m venv\n", "")


def test_another_python_is_taken_unless_one_is_named(run):
    pythons = {"python3": ("3.15", "true", "true"), "python3.12": ("3.12", "true", "false")}
    status, out, err = run(pythons)
    assert (status, out) == (0, "python3.12 -m venv\n")
    assert err == "python3 is 3.15, so python3.12 is taken.\n"


def test_a_named_python_is_not_replaced(run):
    pythons = {"python3": ("3.12", "true", "true"), "python3.15": ("3.15", "true", "true")}
    status, out, err = run(pythons, PYTHON="python3.15")
    assert (status, out) == (1, "")
    assert err.startswith("python3.15 is 3.15: install")


def test_the_versions_of_python_are_the_same_everywhere():
    """In the three packages, the classifiers, both READMEs that name them, and CI."""
    folders = [ROOT, ROOT / "extras/beyond", ROOT / "extras/contacts"]
    projects = [tomllib.loads((folder / "pyproject.toml").read_text("utf-8")) for folder in folders]
    assert {project["project"]["requires-python"] for project in projects} == {">=3.11,<3.15"}
    classifiers = projects[0]["project"]["classifiers"]
    named = [
        classifier.rpartition(" ")[2]
        for classifier in classifiers
        if ":: Python :: 3." in classifier
    ]
    assert named == ["3.11", "3.12", "3.13", "3.14"]
    for page in "README.md", "extras/contacts/README.md":
        assert "Python 3.11 to 3.14" in (ROOT / page).read_text("utf-8")
    workflow = yaml.safe_load((ROOT / ".github/workflows/ci.yml").read_text("utf-8"))
    matrix = workflow["jobs"]["replication"]["strategy"]["matrix"]
    assert matrix["python"] == [named[0], named[-1]]


@pytest.mark.parametrize("package", [ROOT, ROOT / "extras/beyond"], ids=["root", "beyond"])
def test_make_has_a_cache_for_snakemake_without_a_writable_home(package, tmp_path):
    """`XDG_CACHE_HOME` of the user counts."""

    def cache(**given):
        rule = "cache: ; @echo $$XDG_CACHE_HOME"
        command = ["make", "-s", "-C", str(package), f"--eval={rule}", "cache"]
        environment = {name: value for name, value in os.environ.items() if "XDG" not in name}
        return subprocess.check_output(command, env=environment | given, text=True).strip()

    assert cache(HOME="/dev/null/none") == f"{package}/.snakemake/cache"
    assert cache(HOME=str(tmp_path)) == ""
    assert cache(HOME="/dev/null/none", XDG_CACHE_HOME="/mine") == "/mine"
