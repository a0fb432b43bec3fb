"""The RO-Crate of the results against the rules of RO-Crate 1.1."""

import contextlib
import json
import runpy
from datetime import date
from pathlib import Path

import pytest

from bouncing_ball.record.crate import CONTEXT, NAME, PROFILE, crate
from bouncing_ball.record.provenance import ProvenanceError, file_digest
from bouncing_ball.record.revision import commit_date

ROOT = Path(__file__).resolve().parents[2]
SmallRun = runpy.run_path(str(ROOT / "tests" / "attack" / "provenance.py"))["SmallRun"]
ABOUT = {
    "name": "A small run",
    "description": "For the test",
    "license": "https://spdx.org/licenses/BSD-3-Clause",
    "datePublished": "2026-01-31",
}


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    folder = tmp_path_factory.mktemp("world")
    with contextlib.chdir(folder):
        run = SmallRun(folder)
        run.create()
    return run


@pytest.fixture
def made(world, monkeypatch):
    monkeypatch.chdir(world.folder)
    return crate(world.recipes(), ABOUT)


def references(entity):
    """All names that an entity refers to."""
    for key, value in entity.items():
        for part in value if isinstance(value, list) else [value]:
            if key != "@id" and isinstance(part, dict):
                yield part["@id"]


def by_id(made):
    return {entity["@id"]: entity for entity in made["@graph"]}


def test_the_graph_is_flat_and_closed(made):
    assert made["@context"] == CONTEXT
    graph = by_id(made)
    assert len(graph) == len(made["@graph"])
    assert all(entity["@type"] for entity in graph.values())
    # The profile is the one thing that is not of this crate.
    named = {name for entity in graph.values() for name in references(entity)}
    assert named - set(graph) == {PROFILE}
    # JSON-LD, flattened: what is nested is a reference and nothing else.
    for entity in graph.values():
        for value in entity.values():
            for part in value if isinstance(value, list) else [value]:
                assert isinstance(part, str) or set(part) == {"@id"}


def test_the_descriptor_and_the_root(made):
    graph = by_id(made)
    assert graph[NAME]["@type"] == "CreativeWork"
    assert graph[NAME]["conformsTo"] == {"@id": PROFILE}
    assert graph[NAME]["about"] == {"@id": "./"}
    root = graph["./"]
    assert root["@type"] == "Dataset"
    assert root["name"] and root["description"] and root["license"]["@id"] in graph
    assert date.fromisoformat(root["datePublished"])


def test_every_file_is_a_part_and_is_as_it_is_said_to_be(made, world):
    graph = by_id(made)
    files = {name for name, entity in graph.items() if entity["@type"] == "File"}
    assert {part["@id"] for part in graph["./"]["hasPart"]} == files
    assert files == {
        path.removeprefix("results/") for each in world.recipes() for path in each.outputs
    }
    for name in files:
        path = Path("results", name)
        assert graph[name]["contentSize"] == str(path.stat().st_size)
        assert graph[name]["identifier"] == f"sha256:{file_digest(path)}"


def test_every_file_is_the_result_of_one_action(made):
    graph = by_id(made)
    actions = [entity for entity in graph.values() if entity["@type"] == "CreateAction"]
    results = sorted(part["@id"] for action in actions for part in action["result"])
    assert results == sorted(name for name, each in graph.items() if each["@type"] == "File")
    for action in actions:
        tool = graph[action["instrument"]["@id"]]
        assert "SoftwareApplication" in tool["@type"] and tool["softwareRequirements"]


def test_it_is_the_same_every_time(made, world):
    again = crate(reversed(world.recipes()), ABOUT)
    assert json.dumps(again) == json.dumps(made)


def test_a_file_without_provenance_is_refused(world, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    with pytest.raises((ProvenanceError, OSError)):
        crate(world.recipes(), ABOUT)


def test_the_date_is_that_of_the_commit(tmp_path, one_line):
    with pytest.raises(ValueError) as error:
        commit_date(tmp_path)
    one_line(error, "no commit", "date")
