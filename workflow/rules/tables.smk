# From datasets to tables as CSV and Markdown: each table is made from the dataset with its name.

TABLES = ["table1", "thresholds", "ext_orders", "ext_laws", "ext_engines"]
TABLES += ["formulas", "forensics", "witness", "claims"]


rule set_table:
    """A table as CSV and in Markdown."""
    message:
        "Setting {wildcards.table}"
    input:
        data="results/figures/{table}.nc",
        head=words_before,
        source=modules("figures.tables.rows"),
    output:
        csv="results/figures/{table}.csv",
        md="results/figures/{table}.md",
    wildcard_constraints:
        table="|".join(TABLES),
    log:
        "results/logs/tables/{table}.log",
    script:
        "../scripts/table.py"
