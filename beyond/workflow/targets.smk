# A target for each artifact, with its dataset: `snakemake --cores 2 ext_map`.


rule ext_instant:
    """Flights before and after a contact meet at the centroid of its force."""
    localrule: True
    input:
        rules.compute_ext_instant.output,
        rules.draw_ext_instant.output,


rule ext_orders:
    """Order of convergence of the restitution model and of the corrected one."""
    localrule: True
    input:
        rules.compute_ext_orders.output,
        rules.draw_ext_orders.output,
        rules.set_ext_orders.output,


rule ext_map:
    """How stiff a contact must be for the greatest height, over r and Λ."""
    localrule: True
    input:
        rules.compute_ext_map.output,
        rules.draw_ext_map.output,


rule ext_release:
    """Bifurcations and thresholds under both release rules."""
    localrule: True
    input:
        rules.compute_ext_release.output,


rule ext_impact:
    """Restitution and duration of a free impact, by damping and release rule."""
    localrule: True
    input:
        rules.compute_ext_impact.output,
        rules.draw_ext_impact.output,


rule ext_laws:
    """Errors of the restitution model and of the corrected one on the contacts of engineers."""
    localrule: True
    input:
        rules.compute_ext_laws.output,
        rules.draw_ext_laws.output,
        rules.set_ext_laws.output,


rule ext_flights:
    """From permanent contact to chattering: the cascade of flights in a period."""
    localrule: True
    input:
        rules.compute_ext_flights.output,
        rules.draw_ext_flights.output,


rule explorer:
    """A page to explore the models, and the orbits that it checks itself against."""
    localrule: True
    input:
        rules.compute_explorer.output,
        rules.draw_explorer.output,
