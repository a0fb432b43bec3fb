# The figures of each stage are drawn from its datasets, in one job: most of its time is that for the
# imports. The rules have the names of the stages, as targets.


rule schematics:
    """Figures 1 and 4: the two models"""
    input:
        code=code("draw"),
    output:
        **pictures("schematics"),
    log:
        "results/logs/schematics.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"


rule restitution_model:
    """Figures 2 and 3: the restitution model"""
    input:
        data=figure_datasets("restitution_model"),
        code=code("draw"),
    output:
        **pictures("restitution_model"),
    log:
        "results/logs/restitution_model.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"


rule apparent_restitution:
    """Figures 5, 6, 10 and 13: orbits along the frequency ratio"""
    input:
        data=figure_datasets("apparent_restitution"),
        code=code("draw"),
    output:
        **pictures("apparent_restitution"),
    log:
        "results/logs/apparent_restitution.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"


rule continuation:
    """Figures 8, 9 and 15: continuation of n-T orbits along the amplitude"""
    input:
        data=figure_datasets("continuation"),
        code=code("draw"),
    output:
        **pictures("continuation"),
    log:
        "results/logs/continuation.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"


rule permanent_contact:
    """Figures 11 and 16: permanent contact"""
    input:
        data=figure_datasets("permanent_contact"),
        code=code("draw"),
    output:
        **pictures("permanent_contact"),
    log:
        "results/logs/permanent_contact.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"


rule error_thresholds:
    """Figure 14: the error of the restitution model"""
    input:
        data=figure_datasets("error_thresholds"),
        code=code("draw"),
    output:
        **pictures("error_thresholds"),
    log:
        "results/logs/error_thresholds.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"


rule time_histories:
    """Figures 7 and 12: motions over time"""
    input:
        data=figure_datasets("time_histories"),
        code=code("draw"),
    output:
        **pictures("time_histories"),
    log:
        "results/logs/time_histories.log",
    conda:
        "../envs/environment.yaml"
    script:
        "../scripts/draw.py"
