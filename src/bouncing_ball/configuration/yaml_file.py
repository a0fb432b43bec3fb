"""Reading YAML files, with a message of one line for a mistake.

A duplicate key is an error, because otherwise the last value would be used without a warning.
"""

from pathlib import Path
from typing import Any

import yaml

from bouncing_ball.errors import ModelError, escaped

# The loader of libyaml, where PyYAML was built with it, is ten times as fast. Both loaders read the
# same language.
_BASE = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class ConfigurationError(ModelError):
    """A wrong key, type or value in a file. The message is one line that is safe to print."""

    def __init__(self, text: str) -> None:
        super().__init__(escaped(text))


class _Loader(_BASE):  # type: ignore[misc, valid-type]
    """A loader of the safe subset of YAML that refuses duplicate keys in a mapping."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict:
        seen = set()
        for key, _ in node.value:
            if str(key.value) in seen:
                line = key.start_mark.line + 1
                raise ConfigurationError(f"duplicate key {key.value!r} in line {line}")
            seen.add(str(key.value))
        return super().construct_mapping(node, deep)


def parse_yaml(text: str) -> Any:
    """The content of a YAML text.

    Raises
    ------
    ConfigurationError
        If the text is not YAML or has a duplicate key.

    Examples
    --------
    >>> parse_yaml("{n: [1, 2], release: force}")
    {'n': [1, 2], 'release': 'force'}
    >>> parse_yaml("{n: 1, n: 2}")
    Traceback (most recent call last):
    ...
    bouncing_ball.configuration.yaml_file.ConfigurationError: duplicate key 'n' in line 1
    """
    try:
        return yaml.load(text, Loader=_Loader)
    except yaml.MarkedYAMLError as error:
        line = f" in line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise ConfigurationError(f"not YAML{line}: {error.problem}") from None
    except yaml.YAMLError as error:
        # For example a character that is not allowed in YAML.
        raise ConfigurationError(f"not YAML: {' '.join(str(error).split())}") from None


def read_yaml(path: str | Path) -> Any:
    """The content of a YAML file.

    Raises
    ------
    ConfigurationError
        If the file does not exist, is not UTF-8, or :func:`parse_yaml` refuses its text. The
        message does not name the file.
    """
    try:
        return parse_yaml(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise ConfigurationError(str(error.strerror)) from None
    except UnicodeDecodeError:
        raise ConfigurationError("not UTF-8 text") from None
