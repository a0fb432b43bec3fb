# The atlas: how stiff is stiff enough for all orbits. It is not part of a run. Its summary is
# accepted by hand, see docs/atlas.md, and the article takes its numbers from this summary.

from bouncing_ball.beyond.atlas.jobs import minutes, names

ATLAS = config["atlas"]
CHARTS = ["bounce_velocity", "phase", "apparent_restitution", "page"]


rule atlas_shard:
    """Some rows of tiles of the atlas, or the limits of all tiles."""
    message:
        "Atlas: shard {wildcards.shard}"
    input:
        code=lambda wildcards: code("atlas-shards", "atlas_shard.py"),
    output:
        data="results/atlas/shards/{shard}.nc",
    wildcard_constraints:
        # Some rows of tiles; or saddle-node, period doubling and permanent contact of all tiles.
        shard=r"\d+-of-\d+|limits",
    params:
        title="The atlas: the answers of some rows of tiles, or about the limits of all families",
        parameters=ATLAS,
    resources:
        runtime=lambda wildcards: minutes(ATLAS),
        mem_mb=1000,
    log:
        "results/logs/atlas/shards/{shard}.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/atlas_shard.py"


rule atlas_merge:
    message:
        "Atlas: one file from its shards"
    input:
        code=lambda wildcards: code("atlas", "atlas_merge.py"),
        parts=lambda wildcards: expand(
            rules.atlas_shard.output.data, shard=[*names(ATLAS), "limits"]
        ),
    output:
        data="results/atlas/atlas.nc",
    params:
        title="The atlas: how stiff a contact must be",
        parameters=ATLAS,
    log:
        "results/logs/atlas/atlas.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/atlas_merge.py"


rule atlas:
    message:
        "Atlas: its summary, with charts"
    input:
        code=lambda wildcards: code("atlas-summary", "atlas.py", "beyond.atlas.shards"),
        parts=[rules.atlas_merge.output.data],
    output:
        data="results/atlas/summary.nc",
        charts=expand("results/atlas/{chart}.png", chart=CHARTS),
    params:
        title="The atlas in short",
        drawing=ARTIFACTS["ext_atlas"].drawn_by,
        parameters=ATLAS,
    log:
        "results/logs/atlas/charts.log",
    conda:
        ENVIRONMENT
    script:
        "../scripts/atlas.py"
