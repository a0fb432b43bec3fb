"""YAML files, read with one line per mistake."""

from pathlib import Path
from typing import Any

import yaml

from bouncing_ball.errors import ModelError

# Five times as fast, where PyYAML was built with it; it reads the same language.
_LOADER = getattr(yaml, "CSafeLoader", yaml.SafeLoader)


class ConfigurationError(ModelError):
    """A wrong key, type or value in the configuration, in one line."""


def read_yaml(path: str | Path) -> Any:
    """The content of a YAML file.

    Raises
    ------
    ConfigurationError
        One line, which does not name the file: it is not there, not UTF-8 or
        not YAML.
    """
    try:
        return yaml.load(Path(path).read_text(encoding="utf-8"), Loader=_LOADER)
    except OSError as error:
        raise ConfigurationError(str(error.strerror)) from None
    except UnicodeDecodeError:
        raise ConfigurationError("not UTF-8 text") from None
    except yaml.MarkedYAMLError as error:
        line = f" in line {error.problem_mark.line + 1}" if error.problem_mark else ""
        raise ConfigurationError(f"not YAML{line}: {error.problem}") from None
    except yaml.YAMLError as error:
        # A character that no YAML file may hold.
        raise ConfigurationError(f"not YAML: {' '.join(str(error).split())}") from None
    except ValueError as error:
        # What looks like a date and is none.
        raise ConfigurationError(f"not YAML: {error}") from None
