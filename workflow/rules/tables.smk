# From datasets to tables as CSV and Markdown: each table is made from the dataset with its name.

TABLES = {
    "table1": "paper.exhibits.continuation_of_orbits_figures.table1",
    "thresholds": "paper.exhibits.error_thresholds_figures.thresholds",
    "ext_orders": "beyond.exhibits.corrected_model_figures.ext_orders",
    "ext_laws": "beyond.exhibits.contact_laws_figures.ext_laws",
    "ext_engines": "beyond.exhibits.engine_steps_figures.ext_engines",
    "formulas": "paper.claims.tables.formulas",
    "forensics": "paper.claims.tables.forensics",
    "witness": "paper.claims.tables.witness",
    "claims": "paper.claims.tables.claims",
}


rule set_table:
    """A table as CSV and in Markdown."""
    message:
        "Setting {wildcards.table}"
    input:
        data="results/figures/{table}.nc",
        head=words_before,
        source=lambda w: modules(TABLES[w.table].rpartition(".")[0]),
    output:
        csv="results/figures/{table}.csv",
        md="results/figures/{table}.md",
    params:
        table=lambda w: TABLES[w.table],
    wildcard_constraints:
        table="|".join(TABLES),
    log:
        "results/logs/tables/{table}.log",
    script:
        "../scripts/table.py"
