# Targets by name for each figure, table and dataset.

# What each of them is, for `snakemake --list`.
ABOUT = {
    "fig01": "Figure 1: the restitution model, a schematic",
    "fig02": "Figure 2: an n-T orbit of the restitution model",
    "fig03": "Figure 3: n-T orbits of the restitution model along the amplitude",
    "fig04": "Figure 4: the spring-damper model, a schematic",
    "fig05": "Figure 5: apparent restitution along the frequency ratio",
    "fig06": "Figure 6: apparent restitution for several amplitudes",
    "fig07": "Figure 7: one cycle of the spring-damper model",
    "fig08": "Figure 8: 1-T orbits of the spring-damper model along the amplitude",
    "fig09": "Figure 9: 2-T orbits of the spring-damper model along the amplitude",
    "fig10": "Figure 10: bouncing-off velocity along the frequency ratio",
    "fig11": "Figure 11: threshold of permanent contact along the frequency ratio",
    "fig12": "Figure 12: time histories of both models",
    "fig13": "Figure 13: Poincaré map of both models along the frequency ratio",
    "fig14": "Figure 14: greatest height in both models, and its error",
    "fig15": "Figure 15: n-T orbits of both models along the amplitude",
    "fig16": "Figure 16: threshold of permanent contact in both models, and its error",
    "table1": "Table 1: ranges of the amplitude with stable orbits",
    "thresholds": "frequency ratios from which on errors are tolerable",
    "table1_readings": "Table 1 under other readings of what the authors did",
    "three_balls": "periodic, subharmonic and chaotic motion of the restitution model",
    "lowest_doubling": "frequency ratios at which period doublings are lowest",
}


for name in [*FIGURES, *TABLES, "three_balls", "lowest_doubling"]:

    rule:
        name:
            name
        localrule: True
        input:
            files(name),


# The text of a docstring cannot be a variable. As a module with a prefix, rules have other names.
for target in workflow.rules:
    target.docstring = target.docstring or ABOUT.get(target.name)
