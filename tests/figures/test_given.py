"""A figure or a table is made of what it shows, or refused in one line."""

from importlib import import_module

import pytest

from bouncing_ball.configuration.stages import STAGES, Kind, names
from bouncing_ball.errors import ModelError
from bouncing_ball.figures.given import from_dataset
from bouncing_ball.figures.style import style

FIGURES = [name for name in names(Kind.FIGURE, Kind.EXTENSION) if STAGES[name].study]
TABLES = [name for name in names(Kind.TABLE) if name != "claims"]
FAULT = "{0}.py or in the study"
AGAIN = "make it again, snakemake --cores 2 --force results/figures/{0}.nc"


def made(name, data):
    """The figure or the rows, as its job makes them."""
    path = f"results/figures/{name}.nc"
    if name in TABLES:
        return from_dataset(import_module(f"bouncing_ball.figures.tables.{name}").rows, data, path)
    with style():
        draw = import_module(f"bouncing_ball.figures.{name}").draw
        return from_dataset(draw, data, path)


@pytest.mark.parametrize("name", [*FIGURES, *TABLES])
def test_what_is_missing_is_named_with_what_to_do(record, name):
    data = record[name]
    refused = 0
    for variable in data.variables:
        try:
            made(name, data.drop_vars(variable))
        except ModelError as error:
            refused += 1
            assert "\n" not in str(error)
            assert str(error).startswith(f"results/figures/{name}.nc: ")
            again = str(error).endswith(AGAIN.format(name))
            assert again if variable in data.dims else str(error).endswith(FAULT.format(name))
            assert str(variable) in str(error) or "dimension" in str(error)
    assert refused
