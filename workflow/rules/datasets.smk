# The datasets of the paper. Each is computed by the study that its script imports; the rules
# that draw and list them are in figures.smk and tables.smk. All values are dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g,
# with phases in radians.


rule compute_fig02:
    """One orbit of the restitution model over time."""
    message:
        "Computing fig02"
    input:
        code=code("compute_fig02.py"),
    output:
        "results/figures/fig02.nc",
    params:
        artifact=about("fig02"),
        parameters=config["paper"]["fig02"],
    log:
        "results/logs/compute_fig02.log",
    run:
        work("compute_fig02.py", rule, input, output, params, log)


rule compute_fig03:
    """All orbits of the restitution model, in closed form."""
    message:
        "Computing fig03"
    input:
        code=code("compute_fig03.py"),
    output:
        "results/figures/fig03.nc",
    params:
        artifact=about("fig03"),
        parameters=config["paper"]["fig03"],
    log:
        "results/logs/compute_fig03.log",
    run:
        work("compute_fig03.py", rule, input, output, params, log)


rule compute_fig05:
    """Apparent restitution along the frequency ratio, by restitution and amplitude."""
    message:
        "Computing fig05"
    input:
        code=code("compute_fig05.py"),
    output:
        "results/figures/fig05.nc",
    params:
        artifact=about("fig05"),
        parameters=config["paper"]["fig05"],
        release=config["release"],
    log:
        "results/logs/compute_fig05.log",
    run:
        work("compute_fig05.py", rule, input, output, params, log)


rule compute_fig06:
    """Apparent restitution along the frequency ratio, by amplitude."""
    message:
        "Computing fig06"
    input:
        code=code("compute_fig06.py"),
    output:
        "results/figures/fig06.nc",
    params:
        artifact=about("fig06"),
        parameters=config["paper"]["fig06"],
        release=config["release"],
    log:
        "results/logs/compute_fig06.log",
    run:
        work("compute_fig06.py", rule, input, output, params, log)


rule compute_fig07:
    """One cycle of the spring-damper model."""
    message:
        "Computing fig07"
    input:
        code=code("compute_fig07.py"),
    output:
        "results/figures/fig07.nc",
    params:
        artifact=about("fig07"),
        parameters=config["paper"]["fig07"],
        release=config["release"],
    log:
        "results/logs/compute_fig07.log",
    run:
        work("compute_fig07.py", rule, input, output, params, log)


rule compute_fig08:
    """n-T orbits of the spring-damper model of the first family, by continuation."""
    message:
        "Computing fig08"
    input:
        code=code("compute_fig08.py"),
    output:
        "results/figures/fig08.nc",
    params:
        artifact=about("fig08"),
        parameters=config["paper"]["fig08"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/compute_fig08.log",
    run:
        work("compute_fig08.py", rule, input, output, params, log)


rule compute_fig09:
    """n-T orbits of the spring-damper model of the second family, by continuation."""
    message:
        "Computing fig09"
    input:
        code=code("compute_fig09.py"),
    output:
        "results/figures/fig09.nc",
    params:
        artifact=about("fig09"),
        parameters=config["paper"]["fig09"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/compute_fig09.log",
    run:
        work("compute_fig09.py", rule, input, output, params, log)


rule compute_fig10:
    """Bouncing-off velocity along the frequency ratio."""
    message:
        "Computing fig10"
    input:
        code=code("compute_fig10.py"),
    output:
        "results/figures/fig10.nc",
    params:
        artifact=about("fig10"),
        parameters=config["paper"]["fig10"],
        release=config["release"],
    log:
        "results/logs/compute_fig10.log",
    run:
        work("compute_fig10.py", rule, input, output, params, log)


rule compute_fig11:
    """The threshold of permanent contact along the frequency ratio."""
    message:
        "Computing fig11"
    input:
        code=code("compute_fig11.py"),
    output:
        "results/figures/fig11.nc",
    params:
        artifact=about("fig11"),
        parameters=config["paper"]["fig11"],
        release=config["release"],
    log:
        "results/logs/compute_fig11.log",
    run:
        work("compute_fig11.py", rule, input, output, params, log)


rule compute_fig12:
    """Time histories of both models."""
    message:
        "Computing fig12"
    input:
        code=code("compute_fig12.py"),
    output:
        "results/figures/fig12.nc",
    params:
        artifact=about("fig12"),
        parameters=config["paper"]["fig12"],
        release=config["release"],
    log:
        "results/logs/compute_fig12.log",
    run:
        work("compute_fig12.py", rule, input, output, params, log)


rule compute_fig13:
    """The Poincaré map of both models along the frequency ratio."""
    message:
        "Computing fig13"
    input:
        code=code("compute_fig13.py"),
    output:
        "results/figures/fig13.nc",
    params:
        artifact=about("fig13"),
        parameters=config["paper"]["fig13"],
        release=config["release"],
    log:
        "results/logs/compute_fig13.log",
    run:
        work("compute_fig13.py", rule, input, output, params, log)


rule compute_fig14:
    """The frequency ratio from which on the restitution model has the right greatest height."""
    message:
        "Computing fig14"
    input:
        code=code("compute_fig14.py"),
    output:
        "results/figures/fig14.nc",
    params:
        artifact=about("fig14"),
        parameters=config["paper"]["fig14"],
        release=config["release"],
    log:
        "results/logs/compute_fig14.log",
    run:
        work("compute_fig14.py", rule, input, output, params, log)


rule compute_fig15:
    """Existence and stability of n-T orbits of both models, by continuation."""
    message:
        "Computing fig15"
    input:
        code=code("compute_fig15.py"),
    output:
        "results/figures/fig15.nc",
    params:
        artifact=about("fig15"),
        parameters=config["paper"]["fig15"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/compute_fig15.log",
    run:
        work("compute_fig15.py", rule, input, output, params, log)


rule compute_fig16:
    """The threshold of permanent contact of both models, and its error."""
    message:
        "Computing fig16"
    input:
        code=code("compute_fig16.py"),
    output:
        "results/figures/fig16.nc",
    params:
        artifact=about("fig16"),
        parameters=config["paper"]["fig16"],
        release=config["release"],
    log:
        "results/logs/compute_fig16.log",
    run:
        work("compute_fig16.py", rule, input, output, params, log)


rule compute_table1:
    """The ranges of Table 1, by continuation."""
    message:
        "Computing table1"
    input:
        code=code("compute_table1.py"),
    output:
        "results/figures/table1.nc",
    params:
        artifact=about("table1"),
        parameters=config["paper"]["table1"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/compute_table1.log",
    run:
        work("compute_table1.py", rule, input, output, params, log)


rule compute_thresholds:
    """Error thresholds: the frequency ratio from which on the restitution model is accurate."""
    message:
        "Computing thresholds"
    input:
        code=code("compute_thresholds.py"),
    output:
        "results/figures/thresholds.nc",
    params:
        artifact=about("thresholds"),
        parameters=config["paper"]["thresholds"],
        release=config["release"],
    log:
        "results/logs/compute_thresholds.log",
    run:
        work("compute_thresholds.py", rule, input, output, params, log)


rule compute_lowest_doubling:
    """The frequency ratio at which the period doubling of each family is lowest."""
    message:
        "Computing lowest_doubling"
    input:
        code=code("compute_lowest_doubling.py"),
    output:
        "results/figures/lowest_doubling.nc",
    params:
        artifact=about("lowest_doubling"),
        parameters=config["paper"]["lowest_doubling"],
        release=config["release"],
    log:
        "results/logs/compute_lowest_doubling.log",
    run:
        work("compute_lowest_doubling.py", rule, input, output, params, log)


rule compute_three_balls:
    """A periodic, a subharmonic and a chaotic motion of the restitution model."""
    message:
        "Computing three_balls"
    input:
        code=code("compute_three_balls.py"),
    output:
        "results/figures/three_balls.nc",
    params:
        artifact=about("three_balls"),
        parameters=config["paper"]["three_balls"],
    log:
        "results/logs/compute_three_balls.log",
    run:
        work("compute_three_balls.py", rule, input, output, params, log)


rule compute_formulas:
    """The printed formulas against a second computation."""
    message:
        "Computing formulas"
    input:
        code=code("compute_formulas.py"),
    output:
        "results/figures/formulas.nc",
    params:
        artifact=about("formulas"),
        parameters=config["paper"]["formulas"],
    log:
        "results/logs/compute_formulas.log",
    run:
        work("compute_formulas.py", rule, input, output, params, log)


rule compute_forensics:
    """Table 1 under readings of what the authors may have done."""
    message:
        "Computing forensics"
    input:
        code=code("compute_forensics.py"),
    output:
        "results/figures/forensics.nc",
    params:
        artifact=about("forensics"),
    log:
        "results/logs/compute_forensics.log",
    run:
        work("compute_forensics.py", rule, input, output, params, log)


rule compute_witness:
    """Every orbit shown by three routes: continuation, formula and simulation."""
    message:
        "Computing witness"
    input:
        code=code("compute_witness.py"),
        data=[
            "results/figures/fig02.nc",
            "results/figures/fig03.nc",
            "results/figures/fig05.nc",
            "results/figures/fig06.nc",
            "results/figures/fig07.nc",
            "results/figures/fig08.nc",
            "results/figures/fig09.nc",
            "results/figures/fig10.nc",
            "results/figures/fig12.nc",
            "results/figures/fig13.nc",
            "results/figures/fig14.nc",
            "results/figures/fig15.nc",
            "results/figures/table1.nc",
        ],
    output:
        "results/figures/witness.nc",
    params:
        artifact=about("witness"),
    log:
        "results/logs/compute_witness.log",
    run:
        work("compute_witness.py", rule, input, output, params, log)


rule compute_claims:
    """The verdicts on the paper's claims."""
    message:
        "Computing claims"
    input:
        code=code("compute_claims.py"),
        data=[
            "results/figures/fig03.nc",
            "results/figures/fig05.nc",
            "results/figures/fig06.nc",
            "results/figures/fig08.nc",
            "results/figures/fig09.nc",
            "results/figures/fig10.nc",
            "results/figures/fig11.nc",
            "results/figures/fig13.nc",
            "results/figures/fig14.nc",
            "results/figures/fig15.nc",
            "results/figures/fig16.nc",
            "results/figures/table1.nc",
            "results/figures/thresholds.nc",
            "results/figures/lowest_doubling.nc",
            "results/figures/three_balls.nc",
            "results/figures/formulas.nc",
            "results/figures/forensics.nc",
            "results/figures/witness.nc",
        ],
    output:
        "results/figures/claims.nc",
    params:
        artifact=about("claims"),
    log:
        "results/logs/compute_claims.log",
    run:
        work("compute_claims.py", rule, input, output, params, log)
