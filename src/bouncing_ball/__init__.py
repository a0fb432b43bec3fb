"""Two models of a ball bouncing on a vibrating table, and their periodic orbits.

A replication of Carbonelli, Perret-Liaudet, Rigaud and Feki, "Investigation
of restitution coefficient and spring-damper models for the bouncing ball
problem", ASME IDETC/CIE 2011, DETC2011-47870.

The layers, each importing only what lies above it in this list (and the errors):

``datasets``      names, symbols, units and netCDF files
``impacts``       the impact: restitution map, spring-damper contact, permanent contact
``continuation``  pseudo-arclength continuation; knows nothing of balls
``motion``        event-driven simulation, from any initial state
``orbits``        n-T orbits, their stability and bifurcations
``studies``       the stages of the pipeline: parameters in, datasets out
``configuration`` the parameters of a run, read and checked
``audit``         the paper under audit: claims, formulas, Table 1, every orbit by three routes
``render``        figures, tables and the article; they compute nothing
``record``        provenance, the accepted record, and the comparison with it
``pipeline``      what the Snakefile needs of Python
``cli``           the command line, ``bouncing-ball``
"""

__version__ = "0.1.0"
