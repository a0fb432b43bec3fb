# The figures of each stage are drawn from its datasets, in one job: most of its time is that for the
# imports. The rules have the names of the stages, as targets.


rule impacts:
    """Figures of one contact: ext_impact and ext_instant"""
    input:
        data=datasets("impacts").values(),
        code=code("draw"),
    output:
        **pictures("impacts"),
    log:
        "results/logs/impacts.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/draw.py"


rule error_law:
    """Errors of both models along the frequency ratio: ext_orders"""
    input:
        data=datasets("error_law").values(),
        code=code("draw"),
    output:
        **pictures("error_law"),
    log:
        "results/logs/error_law.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/draw.py"


rule stiffness_map:
    """The map of the stiffness that the greatest height needs: ext_map"""
    input:
        data=datasets("stiffness_map").values(),
        code=code("draw"),
    output:
        **pictures("stiffness_map"),
    log:
        "results/logs/stiffness_map.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/draw.py"


rule contact_laws:
    """Errors on contacts of five laws: ext_laws"""
    input:
        data=datasets("contact_laws").values(),
        code=code("draw"),
    output:
        **pictures("contact_laws"),
    log:
        "results/logs/contact_laws.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/draw.py"


rule phases:
    """The plane of touches, and the level that they tell: ext_phase"""
    input:
        data=datasets("phases").values(),
        code=code("draw"),
    output:
        **pictures("phases"),
    log:
        "results/logs/phases.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/draw.py"


rule explorer:
    """A page to explore the models, with the orbits that it checks itself against"""
    input:
        data=datasets("explorer").values(),
        page=[package(path) for path in EXPLORER],
        code=code("explorer_page"),
    output:
        html="results/figures/explorer.html",
    log:
        "results/logs/explorer.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/explorer_page.py"
