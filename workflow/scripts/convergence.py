"""How much each number and each picture moves with what should not matter."""

import io

from bouncing_ball.audit.convergence import Variation, computations, sensitivity
from bouncing_ball.compare.budgets import changes
from bouncing_ball.compare.pictures import compare_pictures, read_picture
from bouncing_ball.compare.tolerance_file import read_tolerances
from bouncing_ball.configuration.study import load
from bouncing_ball.datasets.files import write_text
from bouncing_ball.datasets.netcdf import parameter_attributes
from bouncing_ball.figures import DRAWINGS
from bouncing_ball.figures.style import style
from bouncing_ball.figures.tables.formats import to_csv
from bouncing_ball.pipeline.job import logged


def picture(name, computation, data):
    """The figure as its pixels, labelled with the parameters of the stage itself."""
    file = io.BytesIO()
    labels = parameter_attributes(
        {**computation.parameters, "release": snakemake.params.run["release"]}
    )
    with style():
        load(f"figures.{DRAWINGS[name]}")(data.assign_attrs(labels)).savefig(file, format="png")
    return read_picture(file.getvalue())


with logged(snakemake) as lines:
    made = computations(snakemake.params.run)
    rules = read_tolerances(snakemake.input.tolerances)
    rows, budget = [], rules.pictures.allowed
    for name, computation in made.items():
        drawn = {}

        def measure(base, data, name=name, computation=computation, drawn=drawn):
            found = changes(name, base, data, rules)
            if name in snakemake.params.figures:
                if not drawn:
                    drawn["base"] = picture(name, computation, base)
                again = picture(name, computation, data)
                found["picture"] = compare_pictures(drawn["base"], again, budget).rms
            return found

        for variable, row in sensitivity(computation, measure).items():
            cells = [f"{row[kind]:.1e}" if kind in row else "" for kind in Variation]
            rows.append([name, variable, *cells])
        lines.append(name)
    table = to_csv(["artifact", "variable", *map(str, Variation)], rows)
    write_text(snakemake.output.changes, table)
