"""A figure or a table is made of what it shows, or refused in one line."""

import numpy as np
import pytest

from bouncing_ball.configuration.study import load
from bouncing_ball.datasets.emptiness import statement
from bouncing_ball.errors import ModelError
from bouncing_ball.figures import DRAWINGS
from bouncing_ball.figures.given import require_numbers
from bouncing_ball.figures.style import style


@pytest.mark.parametrize("name", ["fig05", "ext_rattling", "ext_validity"])
def test_a_dataset_without_numbers_is_drawn_only_if_it_says_so(record, one_line, name):
    data = record[name].copy(deep=True)
    for values in data.data_vars.values():
        if values.dtype.kind == "f":
            values.values[...] = np.nan
    path = f"results/figures/{name}.nc"
    with pytest.raises(ModelError) as error:
        require_numbers(data, path)
    one_line(error, f"{path}: no finite number in ")
    assert str(error.value).endswith(f"make it again, snakemake --cores 2 --force {path}")
    with style():
        assert load(f"figures.{DRAWINGS[name]}")(
            require_numbers(data.assign_attrs(statement(data)), path)
        )
