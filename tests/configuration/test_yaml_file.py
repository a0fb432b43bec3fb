"""Files of the configuration that are no YAML, or not there."""

import re
import shutil
from pathlib import Path

import pytest

import bouncing_ball
from bouncing_ball.audit.claims.ledger_file import read_ledger
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml
from bouncing_ball.record.diff.tolerance_file import read_tolerances

ROOT = Path(bouncing_ball.__file__).resolve().parents[2]


MISTAKES = pytest.mark.parametrize(
    ("content", "said"),
    [
        (None, "No such file or directory"),
        ("close_within: ü".encode("latin-1"), "not UTF-8 text"),
        (b"a: 1\nb: \x07\n", "not YAML: "),
        (b"a: 1\nb: [1\n", "not YAML in line 3: "),
        (b"a: 1\nb: !!python/name:os.system\n", "not YAML in line 2: "),
        (b"a: 2011-13-45\n", "not YAML: "),
    ],
)


@MISTAKES
def test_a_mistake_is_one_line(tmp_path, one_line, content, said):
    path = tmp_path / "a.yaml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ConfigurationError, match=f"^{re.escape(said)}") as error:
        read_yaml(path)
    one_line(error, said)


@MISTAKES
def test_the_ledger_and_the_tolerances(tmp_path, one_line, content, said):
    shutil.copyfile(ROOT / "config" / "claims.schema.yaml", tmp_path / "claims.schema.yaml")
    path = tmp_path / "claims.yaml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ConfigurationError) as error:
        read_ledger(tmp_path)
    one_line(error, said)
    with pytest.raises(ConfigurationError) as error:
        read_tolerances(path)
    one_line(error, f"{path}: {said}")


@pytest.mark.parametrize("content", ["", "- 1\n", "text\n"])
def test_no_mapping(tmp_path, one_line, content):
    shutil.copyfile(ROOT / "config" / "claims.schema.yaml", tmp_path / "claims.schema.yaml")
    (tmp_path / "claims.yaml").write_text(content, encoding="utf-8")
    with pytest.raises(ConfigurationError) as error:
        read_ledger(tmp_path)
    one_line(error, "the whole file = ", "must be a mapping of keys")
