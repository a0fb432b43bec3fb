"""The generated parts of README, and the page of the accepted files."""

from pathlib import Path

from bouncing_ball.datasets.files import read_dataset, write_text
from bouncing_ball.paper.artifacts import ARTIFACTS
from bouncing_ball.paper.claims.claim_tables import Claims
from bouncing_ball.paper.claims.claims import tally
from bouncing_ball.pipeline.article import render_article
from bouncing_ball.pipeline.front import links, thumbnails, with_parts
from bouncing_ball.pipeline.job import logged


def pages(top):
    """The texts by their paths, from the accepted datasets of a checkout."""
    data = {name: read_dataset(top / f"figures/{name}.nc") for name in ("claims", "table1")}
    tables = {"tally": tally(data["claims"])}
    claims = Claims(data["claims"])
    templates = sorted(top.glob("workflow/report/front/*.md.j2"))
    parts = {
        path.name.removesuffix(".md.j2"): render_article(path, data, tables, claims, ARTIFACTS)
        for path in templates
    }
    parts["figures"] = thumbnails(ARTIFACTS.values())
    readme = with_parts((top / "README.md").read_text(encoding="utf-8"), parts)
    files = {each.name: links(top / "figures", each) for each in ARTIFACTS.values()}
    template = top / "workflow/report/figures.md.j2"
    return {
        "README.md": readme,
        "figures/README.md": render_article(template, data, files, claims, ARTIFACTS),
    }


if "snakemake" in globals():
    with logged(snakemake) as written:
        top = Path(snakemake.scriptdir).resolve().parents[1]
        for path, text in pages(top).items():
            write_text(top / path, text)
            written.append(path)
