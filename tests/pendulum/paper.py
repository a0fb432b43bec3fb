from pathlib import Path

from paper_replication.provenance import reading

with reading(snakemake.input) as sources:
    from pendulum import CLAIMS, PAGES, PROJECT, TEXT

    from paper_replication import pages
    from paper_replication.datasets import read, save, save_record
    from paper_replication.judgements import judged
    from paper_replication.origins import bare, origins
    from paper_replication.templates import environment

    datasets = {"fig1": read(snakemake.input.data)}
    verdicts = judged(datasets, CLAIMS, [], "")
    save(verdicts, snakemake.output.claims, "Claims", {}, sources, PROJECT)
    datasets["claims"] = read(snakemake.output.claims)
    text = environment(PROJECT.top, marked=True).from_string(TEXT).render(datasets)
    origin = origins(TEXT, datasets)
    parts = pages.parts(datasets, snakemake.params.entries, CLAIMS, {})
    written = {
        "paper.md": bare(text),
        "paper.html": pages.page_of(text, "paper", origin, PAGES),
        "numbers.html": pages.numbers({"paper": text}, {"paper": origin}, datasets, PAGES),
        "index.html": pages.results("Pendulum", datasets, parts, PAGES),
    }
    for name, content in written.items():
        Path("results", name).write_text(content, encoding="utf-8")
    save_record(snakemake, sources, PROJECT)
