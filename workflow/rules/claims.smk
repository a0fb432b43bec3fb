# Stages: what statements in words are decided by, and the verdict on each claim.


rule evidence_stage:
    message:
        "Evidence for the paper's statements"
    input:
        data=[f"results/figures/{name}.nc" for name in EVIDENCE],
        source=modules("audit.evidence", "datasets.netcdf"),
    output:
        data="results/figures/evidence.nc",
    params:
        parameters=config["studies"]["evidence"],
    log:
        "results/logs/evidence_stage.log",
    benchmark:
        "results/benchmarks/evidence_stage.tsv"
    script:
        "../scripts/evidence.py"


rule claims_stage:
    message:
        "Verdicts on the paper's claims"
    input:
        data=[f"results/figures/{name}.nc" for name in datasets_of(LEDGER)],
        source=modules("audit.claims.assessment", "audit.claims.tally", "datasets.netcdf", "datasets.files"),
    output:
        data="results/figures/claims.nc",
        tally="results/tally.txt",
    params:
        ledger=LEDGER,
        figures=len(PAPER_FIGURES),
    log:
        "results/logs/claims_stage.log",
    benchmark:
        "results/benchmarks/claims_stage.tsv"
    script:
        "../scripts/claims.py"
