# The figures of the paper, each drawn from its dataset by the script with the name of its rule, and a
# target for each: `snakemake --cores 2 fig08` makes the figure with its dataset, because Snakemake
# would not make a missing dataset again while the pictures exist. Two are schematics without data.


rule draw_fig01:
    message:
        "Drawing fig01"
    input:
        code=code("draw_fig01.py"),
    output:
        png=report(
            "results/figures/fig01.png",
            caption="../report/fig01.rst",
            category="Figures",
            labels={"figure": "fig01"},
        ),
        svg="results/figures/fig01.svg",
    log:
        "results/logs/draw_fig01.log",
    run:
        work("draw_fig01.py", rule, input, output, params, log)


rule fig01:
    """Figure 1, a schematic."""
    localrule: True
    input:
        rules.draw_fig01.output,


rule draw_fig02:
    message:
        "Drawing fig02"
    input:
        code=code("draw_fig02.py"),
        data="results/figures/fig02.nc",
    output:
        png=report(
            "results/figures/fig02.png",
            caption="../report/fig02.rst",
            category="Figures",
            labels={"figure": "fig02"},
        ),
        svg="results/figures/fig02.svg",
    log:
        "results/logs/draw_fig02.log",
    run:
        work("draw_fig02.py", rule, input, output, params, log)


rule fig02:
    """Figure 2 with its dataset."""
    localrule: True
    input:
        "results/figures/fig02.nc",
        rules.draw_fig02.output,


rule draw_fig03:
    message:
        "Drawing fig03"
    input:
        code=code("draw_fig03.py"),
        data="results/figures/fig03.nc",
    output:
        png=report(
            "results/figures/fig03.png",
            caption="../report/fig03.rst",
            category="Figures",
            labels={"figure": "fig03"},
        ),
        svg="results/figures/fig03.svg",
    log:
        "results/logs/draw_fig03.log",
    run:
        work("draw_fig03.py", rule, input, output, params, log)


rule fig03:
    """Figure 3 with its dataset."""
    localrule: True
    input:
        "results/figures/fig03.nc",
        rules.draw_fig03.output,


rule draw_fig04:
    message:
        "Drawing fig04"
    input:
        code=code("draw_fig04.py"),
    output:
        png=report(
            "results/figures/fig04.png",
            caption="../report/fig04.rst",
            category="Figures",
            labels={"figure": "fig04"},
        ),
        svg="results/figures/fig04.svg",
    log:
        "results/logs/draw_fig04.log",
    run:
        work("draw_fig04.py", rule, input, output, params, log)


rule fig04:
    """Figure 4, a schematic."""
    localrule: True
    input:
        rules.draw_fig04.output,


rule draw_fig05:
    message:
        "Drawing fig05"
    input:
        code=code("draw_fig05.py"),
        data="results/figures/fig05.nc",
    output:
        png=report(
            "results/figures/fig05.png",
            caption="../report/fig05.rst",
            category="Figures",
            labels={"figure": "fig05"},
        ),
        svg="results/figures/fig05.svg",
    log:
        "results/logs/draw_fig05.log",
    run:
        work("draw_fig05.py", rule, input, output, params, log)


rule fig05:
    """Figure 5 with its dataset."""
    localrule: True
    input:
        "results/figures/fig05.nc",
        rules.draw_fig05.output,


rule draw_fig06:
    message:
        "Drawing fig06"
    input:
        code=code("draw_fig06.py"),
        data="results/figures/fig06.nc",
    output:
        png=report(
            "results/figures/fig06.png",
            caption="../report/fig06.rst",
            category="Figures",
            labels={"figure": "fig06"},
        ),
        svg="results/figures/fig06.svg",
    log:
        "results/logs/draw_fig06.log",
    run:
        work("draw_fig06.py", rule, input, output, params, log)


rule fig06:
    """Figure 6 with its dataset."""
    localrule: True
    input:
        "results/figures/fig06.nc",
        rules.draw_fig06.output,


rule draw_fig07:
    message:
        "Drawing fig07"
    input:
        code=code("draw_fig07.py"),
        data="results/figures/fig07.nc",
    output:
        png=report(
            "results/figures/fig07.png",
            caption="../report/fig07.rst",
            category="Figures",
            labels={"figure": "fig07"},
        ),
        svg="results/figures/fig07.svg",
    log:
        "results/logs/draw_fig07.log",
    run:
        work("draw_fig07.py", rule, input, output, params, log)


rule fig07:
    """Figure 7 with its dataset."""
    localrule: True
    input:
        "results/figures/fig07.nc",
        rules.draw_fig07.output,


rule draw_fig08:
    message:
        "Drawing fig08"
    input:
        code=code("draw_fig08.py"),
        data="results/figures/fig08.nc",
    output:
        png=report(
            "results/figures/fig08.png",
            caption="../report/fig08.rst",
            category="Figures",
            labels={"figure": "fig08"},
        ),
        svg="results/figures/fig08.svg",
    log:
        "results/logs/draw_fig08.log",
    run:
        work("draw_fig08.py", rule, input, output, params, log)


rule fig08:
    """Figure 8 with its dataset."""
    localrule: True
    input:
        "results/figures/fig08.nc",
        rules.draw_fig08.output,


rule draw_fig09:
    message:
        "Drawing fig09"
    input:
        code=code("draw_fig09.py"),
        data="results/figures/fig09.nc",
    output:
        png=report(
            "results/figures/fig09.png",
            caption="../report/fig09.rst",
            category="Figures",
            labels={"figure": "fig09"},
        ),
        svg="results/figures/fig09.svg",
    log:
        "results/logs/draw_fig09.log",
    run:
        work("draw_fig09.py", rule, input, output, params, log)


rule fig09:
    """Figure 9 with its dataset."""
    localrule: True
    input:
        "results/figures/fig09.nc",
        rules.draw_fig09.output,


rule draw_fig10:
    message:
        "Drawing fig10"
    input:
        code=code("draw_fig10.py"),
        data="results/figures/fig10.nc",
    output:
        png=report(
            "results/figures/fig10.png",
            caption="../report/fig10.rst",
            category="Figures",
            labels={"figure": "fig10"},
        ),
        svg="results/figures/fig10.svg",
    log:
        "results/logs/draw_fig10.log",
    run:
        work("draw_fig10.py", rule, input, output, params, log)


rule fig10:
    """Figure 10 with its dataset."""
    localrule: True
    input:
        "results/figures/fig10.nc",
        rules.draw_fig10.output,


rule draw_fig11:
    message:
        "Drawing fig11"
    input:
        code=code("draw_fig11.py"),
        data="results/figures/fig11.nc",
    output:
        png=report(
            "results/figures/fig11.png",
            caption="../report/fig11.rst",
            category="Figures",
            labels={"figure": "fig11"},
        ),
        svg="results/figures/fig11.svg",
    log:
        "results/logs/draw_fig11.log",
    run:
        work("draw_fig11.py", rule, input, output, params, log)


rule fig11:
    """Figure 11 with its dataset."""
    localrule: True
    input:
        "results/figures/fig11.nc",
        rules.draw_fig11.output,


rule draw_fig12:
    message:
        "Drawing fig12"
    input:
        code=code("draw_fig12.py"),
        data="results/figures/fig12.nc",
    output:
        png=report(
            "results/figures/fig12.png",
            caption="../report/fig12.rst",
            category="Figures",
            labels={"figure": "fig12"},
        ),
        svg="results/figures/fig12.svg",
    log:
        "results/logs/draw_fig12.log",
    run:
        work("draw_fig12.py", rule, input, output, params, log)


rule fig12:
    """Figure 12 with its dataset."""
    localrule: True
    input:
        "results/figures/fig12.nc",
        rules.draw_fig12.output,


rule draw_fig13:
    message:
        "Drawing fig13"
    input:
        code=code("draw_fig13.py"),
        data="results/figures/fig13.nc",
    output:
        png=report(
            "results/figures/fig13.png",
            caption="../report/fig13.rst",
            category="Figures",
            labels={"figure": "fig13"},
        ),
        svg="results/figures/fig13.svg",
    log:
        "results/logs/draw_fig13.log",
    run:
        work("draw_fig13.py", rule, input, output, params, log)


rule fig13:
    """Figure 13 with its dataset."""
    localrule: True
    input:
        "results/figures/fig13.nc",
        rules.draw_fig13.output,


rule draw_fig14:
    message:
        "Drawing fig14"
    input:
        code=code("draw_fig14.py"),
        data="results/figures/fig14.nc",
    output:
        png=report(
            "results/figures/fig14.png",
            caption="../report/fig14.rst",
            category="Figures",
            labels={"figure": "fig14"},
        ),
        svg="results/figures/fig14.svg",
    log:
        "results/logs/draw_fig14.log",
    run:
        work("draw_fig14.py", rule, input, output, params, log)


rule fig14:
    """Figure 14 with its dataset."""
    localrule: True
    input:
        "results/figures/fig14.nc",
        rules.draw_fig14.output,


rule draw_fig15:
    message:
        "Drawing fig15"
    input:
        code=code("draw_fig15.py"),
        data="results/figures/fig15.nc",
    output:
        png=report(
            "results/figures/fig15.png",
            caption="../report/fig15.rst",
            category="Figures",
            labels={"figure": "fig15"},
        ),
        svg="results/figures/fig15.svg",
    log:
        "results/logs/draw_fig15.log",
    run:
        work("draw_fig15.py", rule, input, output, params, log)


rule fig15:
    """Figure 15 with its dataset."""
    localrule: True
    input:
        "results/figures/fig15.nc",
        rules.draw_fig15.output,


rule draw_fig16:
    message:
        "Drawing fig16"
    input:
        code=code("draw_fig16.py"),
        data="results/figures/fig16.nc",
    output:
        png=report(
            "results/figures/fig16.png",
            caption="../report/fig16.rst",
            category="Figures",
            labels={"figure": "fig16"},
        ),
        svg="results/figures/fig16.svg",
    log:
        "results/logs/draw_fig16.log",
    run:
        work("draw_fig16.py", rule, input, output, params, log)


rule fig16:
    """Figure 16 with its dataset."""
    localrule: True
    input:
        "results/figures/fig16.nc",
        rules.draw_fig16.output,
