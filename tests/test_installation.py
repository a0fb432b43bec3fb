"""The library and its command line need the packages of `dependencies` only, and no other house."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

import pytest
import yaml

import bouncing_ball

ROOT = Path(__file__).parents[1]
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text("utf-8"))
EXTRAS = PROJECT["project"]["optional-dependencies"]
# Where a package is not imported by its name.
MODULES = {"pillow": "PIL", "pyyaml": "yaml", "pypandoc_binary": "pypandoc"}
PACKAGES = [re.split(r"[^\w-]", line)[0] for line in EXTRAS["plot"] + EXTRAS["pipeline"]]
ABSENT = [MODULES.get(name, name) for name in PACKAGES if name != "bouncing-ball"]

# What the pipeline needs, with the extras that it includes.
USED = ("pipeline", "plot")

CONTACT = ["--restitution", "0.85", "--frequency-ratio", "10"]
COMMANDS = [
    ["orbit", "--amplitude", "1", *CONTACT],
    ["limits", *CONTACT],
    ["branch", *CONTACT],
    ["permanent-contact", *CONTACT],
    ["simulate", "--amplitude", "1", *CONTACT],
    ["thresholds", "--amplitude", "1", "--restitution", "0.85"],
]


def normal(name):
    """The name of a package as registries compare it."""
    return re.sub("[-_.]+", "-", name).lower()


def alone(code):
    """A program for which the packages of the extras and the other houses are not installed."""
    absent = (
        "import importlib.metadata, sys\n"
        f"sys.modules.update(dict.fromkeys({ABSENT!r}))\n"
        "importlib.metadata.entry_points = lambda **given: ()"
    )
    command = [sys.executable, "-c", f"{absent}\n{code}"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def needed(extra):
    """The line that names an extra, as a regular expression."""
    return (
        rf"\w+ is not installed: install the extra '{extra}', "
        rf'for example pip install "\.\[{extra}\]"'
    )


def refusals(commands):
    """A program that ends each command, and prints its exit status."""
    return (
        "from bouncing_ball.cli.main import main\n"
        f"for command in {commands!r}:\n"
        "    try: main(command)\n"
        "    except SystemExit as end: print(end.code)"
    )


@pytest.mark.long
def test_without_the_extras_calls_and_commands_work_or_say_in_one_line_what_they_need():
    assert {"matplotlib", "snakemake", "yaml"} <= {*ABSENT}
    needs = [["diff", ".", "."], ["explain", "fig08.png"]]
    done = alone(
        "import bouncing_ball\nfrom bouncing_ball.cli.main import main\n"
        "names = [name for name in bouncing_ball.__all__ if getattr(bouncing_ball, name)]\n"
        f"for command in {COMMANDS!r}: main([*command, '--json'])\nprint(names)\n"
        f"{refusals(needs)}\n"
        "drop = bouncing_ball.drop(bouncing_ball.rigid(restitution=0.5), height=1.0)\n"
        "try: drop.plot()\n"
        "except bouncing_ball.ModelError as error: print(error)\n"
    )
    assert done.returncode == 0
    *answers, names = done.stdout.splitlines()[: len(COMMANDS) + 1]
    assert all(json.loads(answer) for answer in answers) and len(answers) == len(COMMANDS)
    assert names == str(bouncing_ball.__all__)
    *statuses, without_pictures = done.stdout.splitlines()[len(COMMANDS) + 1 :]
    assert statuses == ["2"] * len(needs)
    assert re.fullmatch(needed("plot"), without_pictures)
    said = f"bouncing-ball: {needed('pipeline')}\n"
    # On a busy machine a line says that the answer takes long.
    lines = done.stderr.splitlines(keepends=True)
    errors = "".join(line for line in lines if "no answer after" not in line)
    assert re.fullmatch(said * len(needs), errors)


def test_without_the_extras_a_wrong_option_is_named():
    done = alone(refusals([["limits", "--quantity", "phase"]]))
    assert (done.returncode, done.stdout) == (0, "2\n")
    assert re.fullmatch(r"bouncing-ball: unrecognized arguments: --quantity .*\n", done.stderr)


def test_without_the_other_houses_their_commands_say_in_one_line_how_to_install_them():
    commands = {
        "design": "contacts: pip install . ./beyond ./contacts",
        "fit": "contacts: pip install . ./beyond ./contacts",
        "follow": "beyond: pip install . ./beyond",
    }
    given = [[name, "--restitution", "0.85"] for name in commands]
    done = alone(refusals(given))
    assert done.stdout.splitlines() == ["2"] * len(commands)
    assert done.stderr.splitlines() == [
        f"bouncing-ball: {name} is a command of {where}, or make everything"
        for name, where in commands.items()
    ]


def test_the_environment_of_conda_has_the_versions_of_the_lock():
    environment = yaml.safe_load((ROOT / "environment.yml").read_text("utf-8"))
    (*_, pip) = environment["dependencies"]
    lock = re.findall(r"^([\w.-]+)==([^ ;\\]+)", (ROOT / "requirements.lock").read_text(), re.M)
    locked = {normal(name): version for name, version in lock}
    needed = [*PROJECT["project"]["dependencies"], *(line for x in USED for line in EXTRAS[x])]
    names = {normal(re.split(r"[^\w-]", line)[0]) for line in needed} - {"bouncing-ball"}
    given = dict(line.split("==") for line in pip["pip"])
    assert {normal(name): version for name, version in given.items()} == {
        name: locked[name] for name in names
    }


def test_all_files_name_the_same_release():
    version = PROJECT["project"]["version"]
    citation = yaml.safe_load((ROOT / "CITATION.cff").read_text("utf-8"))
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8")
    released = re.findall(r"^## (\d\S*) \((.*)\)$", changes, re.MULTILINE)[0]
    assert bouncing_ball.__version__ == version == citation["version"] == released[0]
    for house in ("beyond", "contacts"):
        other = tomllib.loads((ROOT / house / "pyproject.toml").read_text("utf-8"))
        assert other["project"]["version"] == version
    assert str(citation["date-released"]) == released[1]


def test_the_classifiers_name_the_versions_that_are_tested():
    jobs = yaml.safe_load((ROOT / ".github" / "workflows" / "ci.yml").read_text("utf-8"))["jobs"]
    tested = {
        version
        for job in jobs.values()
        for version in job.get("strategy", {}).get("matrix", {}).get("python", [])
    }
    named = re.findall(r"Python :: (3\.\d+)", "\n".join(PROJECT["project"]["classifiers"]))
    assert {*named} == tested
    assert PROJECT["project"]["requires-python"] == f">={named[0]}"


def test_the_metadata_for_the_journal_are_those_of_the_article():
    metadata = yaml.safe_load((ROOT / "metadata.yaml").read_text("utf-8"))
    article = (ROOT / "paper.md").read_text("utf-8")
    assert article.startswith(f"# {metadata['title']}\n")
    references = yaml.safe_load((ROOT / metadata["bibliography"]).read_text("utf-8"))
    original = {key: text for one in metadata["replication"] for key, text in one.items()}
    (found,) = [one for one in references["references"] if one["id"] == original["bib"]]
    assert found["DOI"] == original["doi"] and found["title"] in original["cite"]
    assert PROJECT["project"]["urls"]["Paper"].endswith(original["doi"])
