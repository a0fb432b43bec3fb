# Targets by name for each figure, table and dataset.


for name in [*FIGURES, *TABLES, "three_balls", "lowest_doubling"]:

    rule:
        name:
            name
        localrule: True
        input:
            files(name),
