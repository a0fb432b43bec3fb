"""The generated parts of README and of two pages on engines, and lists of the accepted files."""

from pathlib import Path

from bouncing_ball.datasets.files import read_dataset, write_text
from bouncing_ball.paper.claims.claims import tally
from bouncing_ball.paper.claims.tables import Claims
from bouncing_ball.pipeline.article import render_article
from bouncing_ball.pipeline.front import folder_page, page_of, thumbnails, with_parts
from bouncing_ball.pipeline.jobs import logged
from bouncing_ball_contacts.documents.bounces_figures import drivers, in_javascript, rapier_974


def lines(path):
    """Those of a text file."""
    return path.read_text(encoding="utf-8").splitlines()


def pages(top, artifacts):
    """The texts by their paths, from the accepted datasets of a checkout."""
    data = {name: read_dataset(top / f"figures/{name}.nc") for name in ("claims", "table1")}
    tables = {"tally": tally(data["claims"])}
    claims = Claims(data["claims"])
    templates = sorted(top.glob("workflow/report/front/*.md.j2"))
    parts = {
        path.name.removesuffix(".md.j2"): render_article(path, data, tables, claims, artifacts)
        for path in templates
    }
    parts["figures"] = thumbnails(artifacts.values())
    readme = with_parts((top / "README.md").read_text(encoding="utf-8"), parts)
    steps = top / "workflow/report/front/engines/time_steps.md.j2"
    run = {"ext_engines": read_dataset(top / "figures/beyond/ext_engines.nc")}
    time_steps = {"time_steps": render_article(steps, run, {}, claims, artifacts)}
    engines = with_parts((top / "docs/engines.md").read_text(encoding="utf-8"), time_steps)
    folders = {page_of(part): folder_page(part, artifacts.values()) for part in ("paper", "beyond")}
    bounces = with_parts(
        (top / "docs/bounces.md").read_text(encoding="utf-8"),
        {
            "drivers": drivers(read_dataset(top / "config/bounce_drivers.nc")),
            "rapier_974": rapier_974(lines(top / "docs/bounces/rapier_974.csv")),
            "javascript": in_javascript(lines(top / "docs/bounces/javascript.csv")),
        },
    )
    written = {"README.md": readme, "docs/engines.md": engines, "docs/bounces.md": bounces}
    return {**written, **folders}


if "snakemake" in globals():
    with logged(snakemake) as written:
        top = Path(snakemake.scriptdir).resolve().parents[1]
        for path, text in pages(top, snakemake.params.artifacts).items():
            write_text(top / path, text)
            written.append(path)
