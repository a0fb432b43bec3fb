# From datasets to tables as CSV and Markdown: each table is made from the dataset with its name.


rule set_table:
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
    benchmark:
        "results/benchmarks/tables/{table}.tsv"
    script:
        "../scripts/table.py"
