# Targets by name: the stages, and each figure, table and dataset.


rule restitution_model:
    """Figures 2 and 3, and three motions of the restitution model"""
    localrule: True
    input:
        [files(name) for name in STAGES["restitution_model"]],


rule apparent_restitution:
    """Figures 5, 6, 10 and 13: orbits along the frequency ratio"""
    localrule: True
    input:
        [files(name) for name in STAGES["apparent_restitution"]],


rule continuation:
    """Figures 8, 9 and 15, and Table 1: continuation of n-T orbits"""
    localrule: True
    input:
        [files(name) for name in STAGES["continuation"]],


rule permanent_contact:
    """Figures 11 and 16: permanent contact"""
    localrule: True
    input:
        [files(name) for name in STAGES["permanent_contact"]],


rule error_thresholds:
    """Figure 14 and the table of thresholds"""
    localrule: True
    input:
        [files(name) for name in STAGES["error_thresholds"]],


rule time_histories:
    """Figures 7 and 12: motions over time"""
    localrule: True
    input:
        [files(name) for name in STAGES["time_histories"]],


for name in [*FIGURES, *TABLES, "three_balls", "lowest_doubling"]:

    rule:
        name:
            name
        localrule: True
        input:
            files(name),
