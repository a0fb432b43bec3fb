"""How much each number and each picture moves with what should not matter."""

import io
from importlib import import_module

from bouncing_ball.audit.convergence import Variation, sensitivity, stages
from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.pipeline.job import logged
from bouncing_ball.record.diff.budgets import changes
from bouncing_ball.record.diff.pictures import compare_pictures
from bouncing_ball.record.diff.tolerance_file import read_tolerances
from bouncing_ball.render.figures.style import style
from bouncing_ball.render.tables.formats import to_csv


def picture(name, stage, data):
    """The figure as PNG, labelled with the parameters of the stage itself."""
    file = io.BytesIO()
    labels = parameter_attributes(
        {**stage.parameters, "release": snakemake.params.config["release"]}
    )
    with style():
        draw = import_module(f"bouncing_ball.render.figures.{name}").draw
        draw(data.assign_attrs(labels)).savefig(file, format="png")
    return file.getvalue()


with logged(snakemake) as lines:
    made = stages(snakemake.params.config, snakemake.params.printed, snakemake.params.evidence)
    rules = read_tolerances(snakemake.input.tolerances)
    rows, budget = [], rules.pictures.allowed
    for name, stage in made.items():
        drawn = {}

        def measure(base, data, name=name, stage=stage, drawn=drawn):
            found = changes(name, base, data, rules)
            if name in snakemake.params.figures:
                if not drawn:
                    drawn["base"] = picture(name, stage, base)
                again = picture(name, stage, data)
                found["picture"] = compare_pictures(drawn["base"], again, budget).rms
            return found

        for variable, row in sensitivity(name, stage, measure).items():
            cells = [f"{row[kind]:.1e}" if kind in row else "" for kind in Variation]
            rows.append([name, variable, *cells])
        lines.append(name)
    table = to_csv(["artifact", "variable", *map(str, Variation)], rows)
    write_text(snakemake.output.changes, table)
