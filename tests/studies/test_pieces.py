"""Places that several jobs follow give the dataset of one job, byte for byte."""

import pytest
import xarray as xr

from bouncing_ball.configuration.study import load, typed
from bouncing_ball.datasets.netcdf import read_dataset, write_dataset
from bouncing_ball.datasets.pieces import Followed, joined, only

GRID = {"amplitude": {"min": 1.0, "max": 4.0, "samples": 3}, "impacts": 200, "confidence": 0.95}
GRID |= {"restitution": {"min": 0.3, "max": 0.8, "samples": 3}, "frequency_ratio": [30.0, 300.0]}
STUDIES = {
    "attractors.locking": GRID | {"phase": 1.0, "impact_speed": 9.0},
    "mean_motion.mean_motions": GRID | {"starts": 3, "samples": 20, "tolerance": 0.01, "seed": 3},
}


@pytest.mark.parametrize("name", STUDIES)
@pytest.mark.parametrize("count", [2, 5])
def test_pieces_give_the_bytes_of_one_job(name, count, tmp_path):
    study, parts = typed(load(f"studies.{name}")), []
    for number in range(count):
        with pytest.raises(Followed) as found:
            study(STUDIES[name], "displacement", follow=only(number, count))
        arrays = {x: ([*f"{x}abc"][-y.ndim :], y) for x, y in found.value.args[0].items()}
        write_dataset(xr.Dataset(arrays), tmp_path / f"{number}.nc")
        parts.append(read_dataset(tmp_path / f"{number}.nc"))
    whole = study(STUDIES[name], "displacement")
    again = study(STUDIES[name], "displacement", follow=joined(parts))
    for x, values in whole.variables.items():
        assert again[x].values.tobytes() == values.values.tobytes(), x
