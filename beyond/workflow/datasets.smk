# The datasets of beyond, each computed by the study that its script imports.


rule compute_ext_instant:
    """Flights before and after a contact, which meet at the centroid of its force."""
    message:
        "Computing ext_instant"
    input:
        code=code("compute_ext_instant.py"),
    output:
        "results/figures/ext_instant.nc",
    params:
        artifact=about("ext_instant"),
        parameters=config["beyond"]["ext_instant"],
        release=config["release"],
    log:
        "results/logs/compute_ext_instant.log",
    run:
        work("compute_ext_instant.py", rule, input, output, params, log)


rule compute_ext_orders:
    """How fast the errors of both models fall along the frequency ratio."""
    message:
        "Computing ext_orders"
    input:
        code=code("compute_ext_orders.py"),
    output:
        "results/figures/ext_orders.nc",
    params:
        artifact=about("ext_orders"),
        parameters=config["beyond"]["ext_orders"],
        release=config["release"],
    log:
        "results/logs/compute_ext_orders.log",
    run:
        work("compute_ext_orders.py", rule, input, output, params, log)


rule compute_ext_map:
    """How stiff a contact must be for the greatest height, over all stable orbits."""
    message:
        "Computing ext_map"
    input:
        code=code("compute_ext_map.py"),
    output:
        "results/figures/ext_map.nc",
    params:
        artifact=about("ext_map"),
        parameters=config["beyond"]["ext_map"],
    log:
        "results/logs/compute_ext_map.log",
    run:
        work("compute_ext_map.py", rule, input, output, params, log)


rule compute_ext_release:
    """Bifurcations and thresholds under both release rules."""
    message:
        "Computing ext_release"
    input:
        code=code("compute_ext_release.py"),
    output:
        "results/figures/ext_release.nc",
    params:
        artifact=about("ext_release"),
        parameters=config["beyond"]["ext_release"],
    log:
        "results/logs/compute_ext_release.log",
    run:
        work("compute_ext_release.py", rule, input, output, params, log)


rule compute_ext_impact:
    """Restitution and duration of a free impact."""
    message:
        "Computing ext_impact"
    input:
        code=code("compute_ext_impact.py"),
    output:
        "results/figures/ext_impact.nc",
    params:
        artifact=about("ext_impact"),
        parameters=config["beyond"]["ext_impact"],
    log:
        "results/logs/compute_ext_impact.log",
    run:
        work("compute_ext_impact.py", rule, input, output, params, log)


rule compute_ext_laws:
    """Errors of both models on contacts with other laws."""
    message:
        "Computing ext_laws"
    input:
        code=code("compute_ext_laws.py"),
    output:
        "results/figures/ext_laws.nc",
    params:
        artifact=about("ext_laws"),
        parameters=config["beyond"]["ext_laws"],
    log:
        "results/logs/compute_ext_laws.log",
    run:
        work("compute_ext_laws.py", rule, input, output, params, log)


rule compute_ext_flights:
    """Flights in a period above the threshold of permanent contact."""
    message:
        "Computing ext_flights"
    input:
        code=code("compute_ext_flights.py"),
    output:
        "results/figures/ext_flights.nc",
    params:
        artifact=about("ext_flights"),
        parameters=config["beyond"]["ext_flights"],
    log:
        "results/logs/compute_ext_flights.log",
    run:
        work("compute_ext_flights.py", rule, input, output, params, log)


rule compute_explorer:
    """Orbits with which the page of the explorer compares its results."""
    message:
        "Computing explorer"
    input:
        code=code("compute_explorer.py"),
    output:
        "results/figures/explorer.nc",
    params:
        artifact=about("explorer"),
        parameters=config["beyond"]["explorer"],
    log:
        "results/logs/compute_explorer.log",
    run:
        work("compute_explorer.py", rule, input, output, params, log)
