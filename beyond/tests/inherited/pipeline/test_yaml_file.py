"""Configuration files that do not exist or are not valid YAML."""

import re
from pathlib import Path

import pytest
import yaml

from bouncing_ball_beyond.inherited.pipeline.yaml_files import (
    ConfigurationError,
    parse_yaml,
    read_yaml,
)

ROOT = Path(__file__).resolve().parents[3]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "No such file or directory"),
        (
            "a: 1\nclose_within: ü".encode("latin-1"),
            "not YAML: unacceptable character #x00fc: invalid",
        ),
        (
            b"a: 1\r\nb:\r\n\tc: 1\r\n",
            "not YAML: while scanning for the next token found character",
        ),
        (b"a: 1\nb: 2011-02-30\n", "not YAML: day is out of range for month"),
        (b"a: 1\nb: !!python/name:os.system\n", "not YAML: could not determine a constructor"),
    ],
)
def test_a_file_that_cannot_be_read_gives_one_line(tmp_path, one_line, content, said):
    path = tmp_path / "a.yaml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ConfigurationError, match=f"^{re.escape(said)}") as error:
        read_yaml(path)
    one_line(error, said)


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("release: a\nb: 1\nrelease: c\n", "duplicate key 'release' in line 3"),
        # Two keys of the mapping in Python, which are the same text.
        ("- {1: a, '1': b}", "duplicate key '1' in line 1"),
        ("? [1, 2]\n: 3", "found unhashable key"),
    ],
)
def test_a_duplicate_key_and_what_yaml_forbids_are_refused(refusal, text, said):
    with refusal(ConfigurationError, said):
        parse_yaml(text)


def test_an_alias_stands_for_what_it_names():
    assert parse_yaml("a: &a [1, 2]\nb: *a") == {"a": [1, 2], "b": [1, 2]}


def test_every_yaml_file_of_the_project_is_read_as_yaml_reads_it():
    files = [path for path in ROOT.glob("*/**/*.yaml") if ".venv" not in str(path)]
    assert len(files) >= 5
    for path in files:
        assert read_yaml(path) == yaml.safe_load(path.read_text(encoding="utf-8")), path
