# The figures of beyond, each drawn from its dataset.


rule draw_ext_instant:
    message:
        "Drawing ext_instant"
    input:
        code=code("draw_ext_instant.py"),
        data="results/figures/ext_instant.nc",
    output:
        png=report(
            "results/figures/ext_instant.png",
            caption="../report/ext_instant.rst",
            category="Figures",
            labels={"figure": "ext_instant"},
        ),
        svg="results/figures/ext_instant.svg",
    log:
        "results/logs/draw_ext_instant.log",
    run:
        work("draw_ext_instant.py", rule, input, output, params, log)


rule draw_ext_orders:
    message:
        "Drawing ext_orders"
    input:
        code=code("draw_ext_orders.py"),
        data="results/figures/ext_orders.nc",
    output:
        png=report(
            "results/figures/ext_orders.png",
            caption="../report/ext_orders.rst",
            category="Figures",
            labels={"figure": "ext_orders"},
        ),
        svg="results/figures/ext_orders.svg",
    log:
        "results/logs/draw_ext_orders.log",
    run:
        work("draw_ext_orders.py", rule, input, output, params, log)


rule draw_ext_map:
    message:
        "Drawing ext_map"
    input:
        code=code("draw_ext_map.py"),
        data="results/figures/ext_map.nc",
    output:
        png=report(
            "results/figures/ext_map.png",
            caption="../report/ext_map.rst",
            category="Figures",
            labels={"figure": "ext_map"},
        ),
        svg="results/figures/ext_map.svg",
    log:
        "results/logs/draw_ext_map.log",
    run:
        work("draw_ext_map.py", rule, input, output, params, log)


rule draw_ext_impact:
    message:
        "Drawing ext_impact"
    input:
        code=code("draw_ext_impact.py"),
        data="results/figures/ext_impact.nc",
    output:
        png=report(
            "results/figures/ext_impact.png",
            caption="../report/ext_impact.rst",
            category="Figures",
            labels={"figure": "ext_impact"},
        ),
        svg="results/figures/ext_impact.svg",
    log:
        "results/logs/draw_ext_impact.log",
    run:
        work("draw_ext_impact.py", rule, input, output, params, log)


rule draw_ext_laws:
    message:
        "Drawing ext_laws"
    input:
        code=code("draw_ext_laws.py"),
        data="results/figures/ext_laws.nc",
    output:
        png=report(
            "results/figures/ext_laws.png",
            caption="../report/ext_laws.rst",
            category="Figures",
            labels={"figure": "ext_laws"},
        ),
        svg="results/figures/ext_laws.svg",
    log:
        "results/logs/draw_ext_laws.log",
    run:
        work("draw_ext_laws.py", rule, input, output, params, log)


rule draw_ext_flights:
    message:
        "Drawing ext_flights"
    input:
        code=code("draw_ext_flights.py"),
        data="results/figures/ext_flights.nc",
    output:
        png=report(
            "results/figures/ext_flights.png",
            caption="../report/ext_flights.rst",
            category="Figures",
            labels={"figure": "ext_flights"},
        ),
        svg="results/figures/ext_flights.svg",
    log:
        "results/logs/draw_ext_flights.log",
    run:
        work("draw_ext_flights.py", rule, input, output, params, log)
