# Datasets in, tables out: CSV and Markdown, each table from the dataset of its name.


# Words before a table: the template and what it includes, and the modules that render it.
def head(wildcards):
    templates = (f"{ARTICLE}/{wildcards.table}_{part}.md.j2" for part in ("head", "columns"))
    needed = [*templates, *modules("figures.article.render")]
    return needed if wildcards.table == "claims" else []


rule set_table:
    message:
        "Setting {wildcards.table}"
    input:
        data="results/figures/{table}.nc",
        head=head,
        source=modules("figures.tables.rows"),
    output:
        csv="results/figures/{table}.csv",
        md="results/figures/{table}.md",
    wildcard_constraints:
        table="|".join(TABLES),
    log:
        "results/logs/tables/{table}.log",
    benchmark:
        "results/benchmarks/tables/{table}.tsv"
    script:
        "../scripts/table.py"
