"""What the artifacts of a run carry: the commit, the configuration, and a command that works."""

import os
import subprocess
import sys
from pathlib import Path

from bouncing_ball.provenance.explain import explain
from bouncing_ball.provenance.origin import CARRIERS, LIBRARIES, read_provenance


def test_every_artifact_carries_its_provenance(pristine):
    commit = pristine.git("rev-parse", "HEAD")
    paths = [path for path in (pristine.path / "results/figures").iterdir()]
    carriers = [path for path in paths if path.suffix in CARRIERS]
    assert len(carriers) > 60
    for path in carriers:
        made = read_provenance(path)
        assert (made["commit"], made["dirty"], made["configuration"]) == (commit, "no", {}), path
        assert (pristine.path / made["target"]).with_suffix(path.suffix) == path
        assert all((pristine.path / name).is_file() for name in made["inputs"]), path
        assert list(made["versions"]) == ["python", *LIBRARIES]


def test_a_commit_runs_nothing_again(complete):
    (complete.path / "README.md").write_text("Another text.\n", encoding="utf-8")
    (complete.path / "requirements.lock").write_text("", encoding="utf-8")
    complete.commit("Other words")
    (complete.path / "README.md").write_text("Not committed.\n", encoding="utf-8")
    assert complete.planned() == set()


def made_by(tree, *arguments) -> dict:
    tree.run("--cores", "1", "fig11", *arguments)
    made = [read_provenance(path) for path in tree.path.glob("results/figures/fig11.*")]
    assert len({(one["commit"], one["dirty"]) for one in made}) == 1
    return made[0]


def test_a_dirty_tree_is_said_to_be_dirty(fresh):
    fresh.edit("contacts/permanent_contact.py")
    assert made_by(fresh)["dirty"] == "yes"


def test_another_configuration_is_named_and_its_command_gives_the_file(complete, monkeypatch):
    folder = complete.path / "results" / "figures"
    picture, before = folder / "fig11.png", (folder / "fig11.png").read_bytes()
    commit = read_provenance(picture)["commit"]
    config = complete.path / "results" / "mine.yaml"
    config.write_text("figures:\n  fig11:\n    restitution: 0.7\n", encoding="utf-8")
    made = made_by(complete, "--configfile", str(config))
    # The tree is clean: a commit and this configuration decide.
    assert (made["commit"], made["dirty"]) == (commit, "no")
    assert made["configuration"] == {"figures": {"fig11": {"restitution": 0.7}}}
    other = picture.read_bytes()
    assert other != before
    monkeypatch.chdir(complete.path)
    answer = explain(Path("results/figures/fig11.png"))
    assert answer["configuration"] == made["configuration"]
    for kind in CARRIERS:
        (folder / f"fig11{kind}").unlink()
    found = complete.environment() | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    for command in answer["make_again"]:
        subprocess.run(command, shell=True, check=True, capture_output=True, env=found)
    assert picture.read_bytes() == other
