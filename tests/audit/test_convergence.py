"""The convergence study: what it varies."""

from pathlib import Path

import numpy as np
import pytest
import xarray as xr
import yaml

from bouncing_ball.audit.convergence import (
    Computation,
    Variation,
    computations,
    on_the_old_grid,
    sensitivity,
    tighter,
    variations,
)
from bouncing_ball.claims.ledger_file import read_ledger
from bouncing_ball.compare.data import compare_datasets
from bouncing_ball.datasets.netcdf import read_dataset

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="module")
def config():
    return yaml.safe_load((ROOT / "config" / "config.yaml").read_text(encoding="utf-8"))


@pytest.fixture(scope="module")
def made(config):
    table = read_ledger(ROOT / "config").table("Table 1")
    return computations(config | {"printed": table})


def test_every_stage_of_the_configuration_is_varied(config, made):
    parts = ("figures", "tables", "extensions", "studies")
    assert set(made) == {name for part in parts for name in config[part]}


def test_a_stage_is_what_the_pipeline_runs(made):
    # The accepted dataset again, but for what another processor rounds.
    for name in ("fig02", "fig05", "fig07", "fig11", "fig16", "forensics", "formulas"):
        record = read_dataset(ROOT / "figures" / f"{name}.nc")
        found = compare_datasets(name, record, made[name].run())
        assert all(each.outcome.agrees for each in found if each.name != "(global attributes)"), (
            found
        )


def test_tighter_settings(config):
    loose = config["continuation"]
    tight = tighter(loose)
    changed = {key: tight[key] / loose[key] for key in loose if tight[key] != loose[key]}
    assert changed == pytest.approx(
        {"newton_tolerance": 0.1, "initial_step": 0.5, "largest_step": 0.5, "max_angle": 0.5}
    )


@pytest.mark.slow
def test_what_is_varied_for_which_stage(made):
    for name, kinds in (
        ("fig11", [Variation.GRID, *[Variation.ROUNDING] * 4]),
        ("fig07", [Variation.ROUNDING] * 4),
        ("fig15", [Variation.TOLERANCES, Variation.GRID, *[Variation.ROUNDING] * 4]),
    ):
        base = made[name].run()
        found = list(variations(made[name], base))
        assert [kind for kind, _ in found] == kinds
        for _, data in found:
            assert {k: v.shape for k, v in data.items()} == {k: v.shape for k, v in base.items()}


def test_the_old_grid_is_every_other_point_of_a_nested_one(made):
    stage = made["fig11"]
    base = stage.run()
    finer = dict(stage.parameters["frequency_ratio"], samples=801)
    fine = stage._replace(parameters=stage.parameters | {"frequency_ratio": finer}).run()
    assert fine.sizes["frequency_ratio"] == 2 * base.sizes["frequency_ratio"] - 1
    again = on_the_old_grid(fine, base)
    # Powers of a ratio: a rounding or two.
    np.testing.assert_allclose(again.frequency_ratio, base.frequency_ratio, rtol=1e-15)


def test_a_known_sensitivity():
    # x = r on a grid, which rounding moves by two units of 2^-53, and a curve
    # of a grid that is not nested, which the finer grid moves.
    def study(parameters):
        count = parameters["samples"]
        return xr.Dataset(
            {"x": ("t", np.full(count, parameters["restitution"])), "y": float(count)}
        )

    stage = Computation(study, {"restitution": 0.75, "samples": 11}, {})
    found = sensitivity(
        stage, lambda base, data: {k: float(np.abs(data[k] - base[k]).max()) for k in base}
    )
    assert found == {
        "x": {Variation.GRID: 0.0, Variation.ROUNDING: 2 * 2.0**-53},
        "y": {Variation.GRID: 10.0, Variation.ROUNDING: 0.0},
    }
