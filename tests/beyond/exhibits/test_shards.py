"""The dataset of a study is the same, to the last bit, from three shards as from one job."""

from inspect import signature
from pathlib import Path

import pytest
import xarray as xr
from adapter import function
from declared_artifacts import ARTIFACTS, STUDIES

from bouncing_ball.datasets.files import read_dataset, write_dataset
from bouncing_ball.datasets.shards import part_of, shard_names
from bouncing_ball.errors import ParameterError
from bouncing_ball.pipeline.configuration import typed
from bouncing_ball.pipeline.jobs import joined_shards
from bouncing_ball.pipeline.yaml_files import read_yaml

GIVEN = read_yaml(Path(__file__).parents[3] / "config/config.yaml")["beyond"]
LOW = {"restitution": {"min": 0.1, "max": 0.2, "samples": 2}}
GRID = LOW | {"amplitude": {"min": 0.8, "max": 1.6, "samples": 4}}
HIGH = {"min": 1.5, "max": 2.0, "samples": 11}
PLACES = {
    # Here a ball ends on another motion if it starts from the fourth amplitude beside its own.
    "ext_diagram": {"restitution": 0.2, "amplitude": HIGH, "samples": 10},
    "ext_locking": GRID,
    "ext_chaos": GRID
    | {"restitution": {"min": 0.5, "max": 0.6, "samples": 2}}
    | {"followed": [200, 300], "bands": [0.55], "resolved": 1.0, "resolved_impacts": 200},
    "ext_means": GRID | {"starts": 5, "samples": 10},
    "ext_locked": LOW | {"nodes": 10},
    "ext_lives": {"balls": 12, "impacts": 50},
    "ext_basins": {"cases": GIVEN["ext_basins"]["cases"][1:], "starts": 10, "random": 10},
}


# The others are made of parts by the same functions.
OFTEN = ("ext_diagram", "ext_chaos", "ext_means")


@pytest.mark.parametrize(
    "name", [pytest.param(x, marks=() if x in OFTEN else pytest.mark.long) for x in PLACES]
)
def test_shards_give_the_dataset_of_one_job(name, recorded, tmp_path, refusal):
    artifact = ARTIFACTS[name]
    places = typed(function(artifact.module, artifact.places))
    study = typed(STUDIES[name])
    given = {"parameters": GIVEN[name] | PLACES[name], "release": "displacement"}
    # The restitution model has no release.
    given = {key: given[key] for key in given.keys() & signature(places).parameters.keys()}
    parts = []
    read = {"data": recorded} if artifact.reads else {}
    for shard in shard_names(3):
        found = places(**given, part=part_of(shard))
        part = {x: ([f"{x}_{k}" for k in range(y.ndim)], y) for x, y in found.items()}
        write_dataset(xr.Dataset(part), tmp_path / "part.nc")
        parts.append(read_dataset(tmp_path / "part.nc"))
    assert study(**given, **read, found=joined_shards(parts)).identical(study(**given, **read))
    with refusal(ParameterError, "shards: 2000 are more than the "):
        places(**given, part=part_of("0000-of-2000"))
