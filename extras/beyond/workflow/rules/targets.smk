# Targets by name for each figure with its tables.

# What each of them is, for `snakemake --list`.
ABOUT = {
    "ext_impact": "restitution and duration of a free impact, by damping and release",
    "ext_instant": "flights before and after a contact meet at the centroid of its force",
    "ext_orders": "errors of both models along the frequency ratio, and their orders",
    "ext_map": "how stiff a contact must be for the greatest height, over r and Λ",
    "ext_laws": "errors of both models on contacts of five laws",
    "ext_phase": "what the phase of the touch tells about a contact",
    "ext_event": "motions from random starts, a dataset without a figure",
}


for name in [*FIGURES, "ext_event"]:

    rule:
        name:
            name
        localrule: True
        input:
            files(name),


# The text of a docstring cannot be a variable. As a module with a prefix, rules have other names.
for target in workflow.rules:
    target.docstring = target.docstring or ABOUT.get(target.name)
