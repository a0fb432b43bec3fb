from pathlib import Path

from paper_replication.provenance import reading

with reading(snakemake.input) as sources:
    from pendulum import CLAIMS, PROJECT, TEXT

    from paper_replication.datasets import read, save, save_record
    from paper_replication.judgements import judged
    from paper_replication.pages import page_of
    from paper_replication.templates import environment

    fig1 = read(snakemake.input.data)
    verdicts = judged({"fig1": fig1}, CLAIMS, [], "")
    save(verdicts, snakemake.output.claims, "Claims", {}, sources, PROJECT)
    text = environment(PROJECT.top).from_string(TEXT).render(fig1=fig1)
    Path(snakemake.output.paper).write_text(text, encoding="utf-8")
    page = page_of(text, "paper", pages={"paper.html": "Article"})
    Path(snakemake.output.page).write_text(page, encoding="utf-8")
    save_record(snakemake, sources, PROJECT)
