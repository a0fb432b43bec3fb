# The tables of beyond, each as CSV and in Markdown from its dataset, and the page of the explorer.

TITLE = "../report/title.rst"


rule set_ext_orders:
    message:
        "Setting ext_orders"
    input:
        code=code("set_ext_orders.py"),
        data="results/figures/ext_orders.nc",
    output:
        csv=report(
            "results/figures/ext_orders.csv",
            caption=TITLE,
            category="Tables",
            labels={"table": "ext_orders"},
        ),
        md="results/figures/ext_orders.md",
    params:
        title=ARTIFACTS["ext_orders"].title,
    log:
        "results/logs/set_ext_orders.log",
    run:
        work("set_ext_orders.py", rule, input, output, params, log)


rule set_ext_laws:
    message:
        "Setting ext_laws"
    input:
        code=code("set_ext_laws.py"),
        data="results/figures/ext_laws.nc",
    output:
        csv=report(
            "results/figures/ext_laws.csv",
            caption=TITLE,
            category="Tables",
            labels={"table": "ext_laws"},
        ),
        md="results/figures/ext_laws.md",
    params:
        title=ARTIFACTS["ext_laws"].title,
    log:
        "results/logs/set_ext_laws.log",
    run:
        work("set_ext_laws.py", rule, input, output, params, log)


# With reference orbits for the check of its results.
rule draw_explorer:
    message:
        "Writing results/figures/explorer.html"
    input:
        code=code("draw_explorer.py"),
        data="results/figures/explorer.nc",
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/draw_explorer.log",
    run:
        work("draw_explorer.py", rule, input, output, params, log)
