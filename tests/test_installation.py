"""The library and its command line need the packages of `dependencies` only."""

import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path

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
USED = ("pipeline", "plot", "proofs")

CONTACT = ["--restitution", "0.85", "--frequency-ratio", "10"]
TABLE = ["--mass", "20 g", "--frequency", "50 Hz", "--acceleration", "0.8 g"]
DESIGN = ["design", *TABLE, "--stiffness", "1e7 N/m", "--restitution", "0.85", "--n", "1"]
COMMANDS = [
    ["orbit", "--amplitude", "1", *CONTACT],
    ["limits", *CONTACT],
    ["error-law", "--amplitude", "1", "--restitution", "0.85"],
    ["permanent-contact", *CONTACT],
    ["simulate", "--amplitude", "1", *CONTACT],
    DESIGN,
]


def normal(name):
    """The name of a package as registries compare it."""
    return re.sub("[-_.]+", "-", name).lower()


def without_extras(code):
    """A program for which the packages of the extras are not installed."""
    absent = f"import sys; sys.modules.update(dict.fromkeys({ABSENT!r}))"
    command = [sys.executable, "-c", f"{absent}\n{code}"]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_without_the_extras_calls_and_commands_work_or_say_in_one_line_what_they_need():
    assert {"matplotlib", "snakemake", "yaml"} <= {*ABSENT}
    needs = {
        "pipeline": (["diff", ".", "."], ["explain", "fig08.png"]),
        "plot": ([*DESIGN, "--plot", "page.png"],),
    }
    commands = [command for each in needs.values() for command in each]
    done = without_extras(
        "import bouncing_ball\nfrom bouncing_ball.cli.main import main\n"
        "names = [name for name in bouncing_ball.__all__ if getattr(bouncing_ball, name)]\n"
        f"for command in {COMMANDS!r}: main([*command, '--json'])\nprint(names)\n"
        f"for command in {commands!r}:\n"
        "    try: main(command)\n"
        "    except SystemExit as end: print(end.code)"
    )
    assert done.returncode == 0
    *answers, names = done.stdout.splitlines()[: len(COMMANDS) + 1]
    assert all(json.loads(answer) for answer in answers) and len(answers) == len(COMMANDS)
    assert names == str(bouncing_ball.__all__)
    assert done.stdout.splitlines()[len(COMMANDS) + 1 :] == ["2"] * len(commands)
    said = [
        rf"bouncing-ball: \w+ is not installed: install the extra '{extra}', "
        rf'for example pip install "\.\[{extra}\]"\n'
        for extra, commands in needs.items()
        for _ in commands
    ]
    assert re.fullmatch("".join(said), done.stderr)


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
