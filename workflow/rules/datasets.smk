# The datasets of the paper. A job computes one, or two where the second costs less than another
# process, with the studies that its script imports; the rules that draw and list them are in
# figures.smk and tables.smk. All values are dimensionless: times Ωt, lengths Ω²y/g, velocities Ωẏ/g,
# with phases in radians.


rule restitution_model_study:
    """The restitution model: one orbit over time, and all orbits in closed form."""
    message:
        "Computing fig02 and fig03"
    input:
        code=code("restitution_model.py"),
    output:
        fig02="results/figures/fig02.nc",
        fig03="results/figures/fig03.nc",
    params:
        artifacts=about("fig02", "fig03"),
        fig02=config["paper"]["fig02"],
        fig03=config["paper"]["fig03"],
    log:
        "results/logs/restitution_model.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/restitution_model.py"


rule apparent_restitution_study:
    """Apparent restitution along the frequency ratio."""
    message:
        "Computing fig05 and fig06"
    input:
        code=code("apparent_restitution.py"),
    output:
        fig05="results/figures/fig05.nc",
        fig06="results/figures/fig06.nc",
    params:
        artifacts=about("fig05", "fig06"),
        fig05=config["paper"]["fig05"],
        fig06=config["paper"]["fig06"],
        release=config["release"],
    log:
        "results/logs/apparent_restitution.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/apparent_restitution.py"


rule frequency_sweeps_study:
    """Bouncing-off velocity and Poincaré map along the frequency ratio."""
    message:
        "Computing fig10 and fig13"
    input:
        code=code("frequency_sweeps.py"),
    output:
        fig10="results/figures/fig10.nc",
        fig13="results/figures/fig13.nc",
    params:
        artifacts=about("fig10", "fig13"),
        fig10=config["paper"]["fig10"],
        fig13=config["paper"]["fig13"],
        release=config["release"],
    log:
        "results/logs/frequency_sweeps.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/frequency_sweeps.py"


rule time_histories_study:
    """Time histories of orbits of the spring-damper model."""
    message:
        "Computing fig07 and fig12"
    input:
        code=code("time_histories.py"),
    output:
        fig07="results/figures/fig07.nc",
        fig12="results/figures/fig12.nc",
    params:
        artifacts=about("fig07", "fig12"),
        fig07=config["paper"]["fig07"],
        fig12=config["paper"]["fig12"],
        release=config["release"],
    log:
        "results/logs/time_histories.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/time_histories.py"


rule orbit_branches_study:
    """Existence and stability of n-T orbits of the spring-damper model, by continuation."""
    message:
        "Computing fig08 and fig09"
    input:
        code=code("orbit_branches.py"),
    output:
        fig08="results/figures/fig08.nc",
        fig09="results/figures/fig09.nc",
    params:
        artifacts=about("fig08", "fig09"),
        fig08=config["paper"]["fig08"],
        fig09=config["paper"]["fig09"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/orbit_branches.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/orbit_branches.py"


rule both_domains_study:
    """Existence and stability of n-T orbits of both models, by continuation."""
    message:
        "Computing fig15"
    input:
        code=code("both_domains.py"),
    output:
        fig15="results/figures/fig15.nc",
    params:
        artifacts=about("fig15"),
        fig15=config["paper"]["fig15"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/both_domains.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/both_domains.py"


rule stability_ranges_study:
    """The ranges of Table 1, by continuation."""
    message:
        "Computing table1"
    input:
        code=code("stability_ranges.py"),
    output:
        table1="results/figures/table1.nc",
    params:
        artifacts=about("table1"),
        table1=config["paper"]["table1"],
        release=config["release"],
        continuation=config["continuation"],
    log:
        "results/logs/stability_ranges.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/stability_ranges.py"


rule permanent_contact_study:
    """Permanent contact: the amplitude from which on the table throws the ball off."""
    message:
        "Computing fig11 and fig16"
    input:
        code=code("permanent_contact.py"),
    output:
        fig11="results/figures/fig11.nc",
        fig16="results/figures/fig16.nc",
    params:
        artifacts=about("fig11", "fig16"),
        fig11=config["paper"]["fig11"],
        fig16=config["paper"]["fig16"],
        release=config["release"],
    log:
        "results/logs/permanent_contact.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/permanent_contact.py"


rule height_error_study:
    """The frequency ratio from which on the restitution model has the right greatest height."""
    message:
        "Computing fig14"
    input:
        code=code("height_error.py"),
    output:
        fig14="results/figures/fig14.nc",
    params:
        artifacts=about("fig14"),
        fig14=config["paper"]["fig14"],
        release=config["release"],
    log:
        "results/logs/height_error.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/height_error.py"


rule error_thresholds_study:
    """Error thresholds: the frequency ratio from which on the restitution model is accurate."""
    message:
        "Computing thresholds"
    input:
        code=code("error_thresholds.py"),
    output:
        thresholds="results/figures/thresholds.nc",
    params:
        artifacts=about("thresholds"),
        thresholds=config["paper"]["thresholds"],
        release=config["release"],
    log:
        "results/logs/error_thresholds.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/error_thresholds.py"


rule lowest_period_doubling_study:
    """The frequency ratio at which the period doubling of each family is lowest."""
    message:
        "Computing lowest_doubling"
    input:
        code=code("lowest_period_doubling.py"),
    output:
        lowest_doubling="results/figures/lowest_doubling.nc",
    params:
        artifacts=about("lowest_doubling"),
        lowest_doubling=config["paper"]["lowest_doubling"],
        release=config["release"],
    log:
        "results/logs/lowest_period_doubling.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/lowest_period_doubling.py"


rule kinds_of_motion_study:
    """A periodic, a subharmonic and a chaotic motion of the restitution model."""
    message:
        "Computing three_balls"
    input:
        code=code("kinds_of_motion.py"),
    output:
        three_balls="results/figures/three_balls.nc",
    params:
        artifacts=about("three_balls"),
        three_balls=config["paper"]["three_balls"],
    log:
        "results/logs/kinds_of_motion.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/kinds_of_motion.py"


rule formulas_study:
    """The printed formulas against a second computation."""
    message:
        "Computing formulas"
    input:
        code=code("formulas.py"),
    output:
        formulas="results/figures/formulas.nc",
    params:
        artifacts=about("formulas"),
        formulas=config["paper"]["formulas"],
    log:
        "results/logs/formulas.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/formulas.py"


rule forensics_study:
    """Table 1 under readings of what the authors may have done."""
    message:
        "Computing forensics"
    input:
        code=code("forensics.py"),
    output:
        forensics="results/figures/forensics.nc",
    params:
        artifacts=about("forensics"),
    log:
        "results/logs/forensics.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/forensics.py"


rule witness_study:
    """Every orbit shown by three routes: continuation, formula and simulation."""
    message:
        "Computing witness"
    input:
        code=code("witness.py"),
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
        witness="results/figures/witness.nc",
    params:
        artifacts=about("witness"),
    log:
        "results/logs/witness.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/witness.py"


rule claims_study:
    """The verdicts on the paper's claims."""
    message:
        "Computing claims"
    input:
        code=code("claims.py"),
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
        claims="results/figures/claims.nc",
    params:
        artifacts=about("claims"),
    log:
        "results/logs/claims.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/claims.py"
