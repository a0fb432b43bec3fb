# The tables of the paper, each as CSV and in Markdown from its dataset, and a target for each as for the
# figures. The page of the claims, which begins with words, is in article.smk.


rule set_table1:
    message:
        "Setting table1"
    input:
        code=code("set_table1.py"),
        data="results/figures/table1.nc",
    output:
        csv=report(
            "results/figures/table1.csv",
            caption="../report/title.rst",
            category="Tables",
            labels={"table": "table1"},
        ),
        md="results/figures/table1.md",
    params:
        title=ARTIFACTS["table1"].title,
    log:
        "results/logs/set_table1.log",
    run:
        work("set_table1.py", rule, input, output, params, log)


rule table1:
    """Table 1 with its dataset."""
    localrule: True
    input:
        "results/figures/table1.nc",
        rules.set_table1.output,


rule set_thresholds:
    message:
        "Setting thresholds"
    input:
        code=code("set_thresholds.py"),
        data="results/figures/thresholds.nc",
    output:
        csv=report(
            "results/figures/thresholds.csv",
            caption="../report/title.rst",
            category="Tables",
            labels={"table": "thresholds"},
        ),
        md="results/figures/thresholds.md",
    params:
        title=ARTIFACTS["thresholds"].title,
    log:
        "results/logs/set_thresholds.log",
    run:
        work("set_thresholds.py", rule, input, output, params, log)


rule thresholds:
    """The error thresholds with its dataset."""
    localrule: True
    input:
        "results/figures/thresholds.nc",
        rules.set_thresholds.output,


rule set_formulas:
    message:
        "Setting formulas"
    input:
        code=code("set_formulas.py"),
        data="results/figures/formulas.nc",
    output:
        csv=report(
            "results/figures/formulas.csv",
            caption="../report/title.rst",
            category="Tables",
            labels={"table": "formulas"},
        ),
        md="results/figures/formulas.md",
    params:
        title=ARTIFACTS["formulas"].title,
    log:
        "results/logs/set_formulas.log",
    run:
        work("set_formulas.py", rule, input, output, params, log)


rule formulas:
    """The check of the printed formulas with its dataset."""
    localrule: True
    input:
        "results/figures/formulas.nc",
        rules.set_formulas.output,


rule set_forensics:
    message:
        "Setting forensics"
    input:
        code=code("set_forensics.py"),
        data="results/figures/forensics.nc",
    output:
        csv=report(
            "results/figures/forensics.csv",
            caption="../report/title.rst",
            category="Tables",
            labels={"table": "forensics"},
        ),
        md="results/figures/forensics.md",
    params:
        title=ARTIFACTS["forensics"].title,
    log:
        "results/logs/set_forensics.log",
    run:
        work("set_forensics.py", rule, input, output, params, log)


rule forensics:
    """The readings of Table 1 with its dataset."""
    localrule: True
    input:
        "results/figures/forensics.nc",
        rules.set_forensics.output,


rule set_witness:
    message:
        "Setting witness"
    input:
        code=code("set_witness.py"),
        data="results/figures/witness.nc",
    output:
        csv=report(
            "results/figures/witness.csv",
            caption="../report/title.rst",
            category="Tables",
            labels={"table": "witness"},
        ),
        md="results/figures/witness.md",
    params:
        title=ARTIFACTS["witness"].title,
    log:
        "results/logs/set_witness.log",
    run:
        work("set_witness.py", rule, input, output, params, log)


rule witness:
    """The comparison of the three routes with its dataset."""
    localrule: True
    input:
        "results/figures/witness.nc",
        rules.set_witness.output,
