"""The datasets by the CF conventions, as far as these apply to data without a place on Earth."""

import re
from pathlib import Path

import netCDF4
import pytest

from bouncing_ball.datasets.files import CONVENTIONS

ROOT = Path(__file__).resolve().parents[2]
DATASETS = sorted(str(path.relative_to(ROOT)) for path in (ROOT / "figures").rglob("*.nc"))
# CF, section 2.3: "should begin with a letter and be composed of letters, digits, and underscores".
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*")
# Reserved by netCDF itself.
OWN = {"_FillValue"}
# CF, section 2.6.2: the description of a file's contents.
DESCRIPTION = ("title", "history", "references")


@pytest.mark.parametrize("dataset", DATASETS, ids=lambda dataset: Path(dataset).stem)
def test_a_dataset_follows_the_cf_conventions(pristine, dataset):
    with netCDF4.Dataset(pristine.path / "results" / dataset) as data:
        assert data.Conventions == CONVENTIONS
        assert all(data.getncattr(key) for key in DESCRIPTION)
        named = [*data.dimensions, *data.variables, *data.ncattrs()]
        for variable in data.variables.values():
            named += [key for key in variable.ncattrs() if key not in OWN]
            assert variable.long_name and variable.units
        assert [key for key in named if not NAME.fullmatch(key)] == []
        # Names differ by more than case.
        assert len({key.lower() for key in data.variables}) == len(data.variables)
        # Nothing is missing in a coordinate.
        coordinates = [data.variables[key] for key in data.dimensions]
        assert [each.name for each in coordinates if "_FillValue" in each.ncattrs()] == []
