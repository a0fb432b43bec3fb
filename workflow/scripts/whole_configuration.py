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
    studies: dict = {"paper": {}}
    for each in artifacts:
        if each.study:
            studies[each.part][each.name] = function(each.module, each.study)
    return configuration_model(studies)
