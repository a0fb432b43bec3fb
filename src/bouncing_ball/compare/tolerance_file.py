"""The tolerance file, read and checked with one line per mistake."""

from pathlib import Path

from bouncing_ball.compare.tolerances import ToleranceError, Tolerances, tolerances_from
from bouncing_ball.configuration.conformity import check_schema
from bouncing_ball.configuration.yaml_file import ConfigurationError, read_yaml

_SCHEMA = Path(__file__).with_suffix(".schema.yaml")


def read_tolerances(path: str | Path) -> Tolerances:
    """The tolerances of a file such as ``config/tolerances.yaml``.

    Raises
    ------
    ConfigurationError
        One line that names the file, the key and what is allowed.
    """
    try:
        content = read_yaml(path)
        check_schema(content, read_yaml(_SCHEMA))
        return tolerances_from(content)
    except (ConfigurationError, ToleranceError) as error:
        raise ConfigurationError(f"{path}: {error}") from None
