# A target for each stage with several figures and tables, and for the datasets that no figure shows:
# `snakemake --cores 2 permanent_contact`.


rule schematics:
    """The schematics of both models: Figures 1 and 4."""
    localrule: True
    input:
        rules.fig01.input,
        rules.fig04.input,


rule restitution_model:
    """The restitution model: Figures 2 and 3."""
    localrule: True
    input:
        rules.fig02.input,
        rules.fig03.input,


rule apparent_restitution:
    """Orbits along the frequency ratio: Figures 5, 6, 10 and 13."""
    localrule: True
    input:
        rules.fig05.input,
        rules.fig06.input,
        rules.fig10.input,
        rules.fig13.input,


rule time_histories:
    """Orbits over time: Figures 7 and 12."""
    localrule: True
    input:
        rules.fig07.input,
        rules.fig12.input,


rule continuation_of_orbits:
    """Continuation of n-T orbits: Figures 8, 9 and 15, and Table 1."""
    localrule: True
    input:
        rules.fig08.input,
        rules.fig09.input,
        rules.fig15.input,
        rules.table1.input,


rule permanent_contact:
    """Thresholds of permanent contact: Figures 11 and 16."""
    localrule: True
    input:
        rules.fig11.input,
        rules.fig16.input,


rule error_thresholds:
    """Error thresholds: Figure 14 and the table of all quantities."""
    localrule: True
    input:
        rules.fig14.input,
        rules.thresholds.input,


rule lowest_doubling:
    """The lowest period doublings, a dataset."""
    localrule: True
    input:
        rules.compute_lowest_doubling.output,


rule three_balls:
    """A periodic, a subharmonic and a chaotic motion, a dataset."""
    localrule: True
    input:
        rules.compute_three_balls.output,
