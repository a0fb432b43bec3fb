"""Two models of a ball bouncing on a vibrating table, and their periodic orbits.

A replication of Carbonelli, Perret-Liaudet, Rigaud and Feki, "Investigation
of restitution coefficient and spring-damper models for the bouncing ball
problem", ASME IDETC/CIE 2011, DETC2011-47870.

The layers, each importing only what lies above it in this list (and the errors):

``datasets``      names, symbols, units and netCDF files
``comparison``    whether two folders of artifacts say the same
``models``        the impact: restitution map, spring-damper contact, permanent contact
``continuation``  pseudo-arclength continuation; knows nothing of balls
``simulation``    event-driven simulation of both models, from any initial state
``orbits``        n-T orbits of both models, their stability and bifurcations
``studies``       the stages of the pipeline: parameters in, arrays out
``claims``        the ledger of the paper's claims and the verdict on each
``figures``       pictures of datasets; they compute nothing
``tables``        tables of datasets
``article``       the replication article from its templates
``pipeline``      what the Snakefile needs of Python
``cli``           the command line, ``bouncing-ball``
"""

__version__ = "0.1.0"
