"""The type of the whole configuration, from the studies of all artifacts."""

from collections.abc import Iterable

from adapter import function
from pydantic import BaseModel

from bouncing_ball.pipeline.artifacts import Artifact
from bouncing_ball.pipeline.configuration import configuration_model


def configuration_type(artifacts: Iterable[Artifact]) -> type[BaseModel]:
    """The type of the configuration: the studies, and settings of the run.

    Raises
    ------
    ConfigurationError
        If there is no function with the name of a study.
    """
    studies: dict = {}
    for each in artifacts:
        if each.study:
            study = function(each.module, each.study)
            studies.setdefault(each.section, {})[each.name] = study
    return configuration_model(studies)
