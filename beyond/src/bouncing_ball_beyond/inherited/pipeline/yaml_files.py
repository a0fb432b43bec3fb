"""Files of YAML, such as the configuration: how they are read, and what is wrong in them in a line.

A duplicate key is a mistake, because otherwise the last value would be used without a warning.
"""

from pathlib import Path
from typing import Any

import yaml

from bouncing_ball_beyond.inherited.errors import ModelError, escaped


class ConfigurationError(ModelError):
    """Wrong keys, types or values in files. The message has a line for each mistake, and is safe to
    print.
    """

    def __init__(self, *mistakes: str) -> None:
        super().__init__("\n".join(map(escaped, mistakes)))

    @property
    def mistakes(self) -> list[str]:
        """The lines of the message."""
        return str(self).split("\n")


# The loader of libyaml, where PyYAML was built with it, is ten times as fast.
_SAFE: Any = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class _Loader(_SAFE):
    """The loader with which Snakemake reads a configuration, but without duplicate keys."""

    def construct_mapping(self, node: yaml.MappingNode, deep: bool = False) -> dict:
        seen = set()
        for key, _ in node.value:
            if str(key.value) in seen:
                line = key.start_mark.line + 1
                raise ConfigurationError(f"duplicate key {key.value!r} in line {line}")
            seen.add(str(key.value))
        return super().construct_mapping(node, deep)


def parse_yaml(text: str | bytes) -> Any:
    """The content of a YAML text, which is decoded as YAML says if it is given in bytes.

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
    bouncing_ball_beyond.inherited.pipeline.yaml_files.ConfigurationError: duplicate key 'n' in \
line 1
    """
    try:
        return yaml.load(text, Loader=_Loader)
    except ConfigurationError:
        raise
    # A day that no month has is a ValueError of the reader.
    except (yaml.YAMLError, ValueError) as error:
        raise ConfigurationError(f"not YAML: {' '.join(str(error).split())}") from None


def read_yaml(path: str | Path) -> Any:
    """The content of a YAML file.

    Raises
    ------
    ConfigurationError
        If the file cannot be read, or :func:`parse_yaml` refuses its text. The message does not
        name the file.
    """
    try:
        text = Path(path).read_bytes()
    except OSError as error:
        raise ConfigurationError(str(error.strerror)) from None
    return parse_yaml(text)
