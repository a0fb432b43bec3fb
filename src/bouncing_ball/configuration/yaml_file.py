"""YAML files, read with one line per mistake.

What YAML says twice or differently from one version to the next is refused: the
last of two equal keys would win without a word, and `1:30` would be 90.
"""

import re
from pathlib import Path
from typing import Any

import yaml

from bouncing_ball.errors import ModelError, escaped

# Ten times as fast, where PyYAML was built with it; it reads the same language.
_BASE = getattr(yaml, "CSafeLoader", yaml.SafeLoader)

# Of all that YAML 1.1 takes for a number or a truth value, what every version does.
_SAME_EVERYWHERE = {
    "int": re.compile(r"[-+]?(0|[1-9][0-9]*)"),
    "float": re.compile(r"[-+]?([0-9]+\.[0-9]*|\.[0-9]+)([eE][-+][0-9]+)?|[-+]?\.inf|\.nan", re.I),
    "bool": re.compile("true|false", re.I),
}


class ConfigurationError(ModelError):
    """A wrong key, type or value in a file, in one line that is safe to print."""

    def __init__(self, text: str) -> None:
        super().__init__(escaped(text))


def _line(node: yaml.Node) -> str:
    return f"in line {node.start_mark.line + 1}"


class _Loader(_BASE):  # type: ignore[misc, valid-type]
    """The safe language without what is ambiguous."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict:
        seen = set()
        for key, _ in node.value:
            if not isinstance(key, yaml.ScalarNode) or key.tag.endswith(":merge"):
                raise ConfigurationError(f"a key {_line(key)} is not a plain text")
            if key.value in seen:
                raise ConfigurationError(f"duplicate key {key.value!r} {_line(key)}")
            seen.add(key.value)
        return super().construct_mapping(node, deep)

    def construct_object(self, node: yaml.Node, deep: bool = False) -> Any:
        kind = node.tag.removeprefix("tag:yaml.org,2002:")
        pattern = _SAME_EVERYWHERE.get(kind)
        if kind == "timestamp" or (pattern and not pattern.fullmatch(node.value)):
            raise ConfigurationError(
                f"{node.value!r} {_line(node)} is read differently from one version of YAML "
                "to the next: write a decimal number, true or false, or quote a text"
            )
        return super().construct_object(node, deep)


def parse_yaml(text: str) -> Any:
    """The content of a YAML text.

    Raises
    ------
    ConfigurationError
        One line: not YAML, a duplicate key, or a number that versions of YAML read
        differently.

    Examples
    --------
    >>> parse_yaml("{n: [1, 2], release: force}")
    {'n': [1, 2], 'release': 'force'}
    >>> parse_yaml("samples: 1:30")
    Traceback (most recent call last):
    ...
    bouncing_ball.configuration.yaml_file.ConfigurationError: '1:30' in line 1 is read differently \
from one version of YAML to the next: write a decimal number, true or false, or quote a text
    """
    try:
        return yaml.load(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        line = f" in line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise ConfigurationError(f"not YAML{line}: {error.problem}") from None
    except yaml.YAMLError as error:
        # A character that no YAML file may hold.
        raise ConfigurationError(f"not YAML: {' '.join(str(error).split())}") from None


def read_yaml(path: str | Path) -> Any:
    """The content of a YAML file.

    Raises
    ------
    ConfigurationError
        One line, which does not name the file: it is not there, not UTF-8, or
        refused by :func:`parse_yaml`.
    """
    try:
        return parse_yaml(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(str(error.strerror)) from None
    except UnicodeDecodeError:
        raise ConfigurationError("not UTF-8 text") from None
