"""The tolerance file, read and checked with one line per mistake."""

from pathlib import Path

import yaml

from bouncing_ball.comparison.tolerances import ToleranceError, Tolerances, tolerances_from
from bouncing_ball.pipeline.configuration import ConfigurationError, check_schema

_SCHEMA = Path(__file__).with_suffix(".schema.yaml")


def read_tolerances(path: str | Path) -> Tolerances:
    """The tolerances of a file such as ``config/tolerances.yaml``.

    Raises
    ------
    ConfigurationError
        One line that names the file, the key and what is allowed.
    """
    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
        check_schema(content, yaml.safe_load(_SCHEMA.read_text(encoding="utf-8")))
        return tolerances_from(content)
    except OSError as error:
        raise ConfigurationError(f"{path}: {error.strerror}") from None
    except UnicodeDecodeError:
        raise ConfigurationError(f"{path}: not UTF-8 text") from None
    except yaml.YAMLError as error:
        raise ConfigurationError(f"{path}: {' '.join(str(error).split())}") from None
    except (ConfigurationError, ToleranceError) as error:
        raise ConfigurationError(f"{path}: {error}") from None
