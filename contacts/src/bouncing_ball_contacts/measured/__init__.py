"""Measured impacts: experiments, the contacts that are fitted to them, and verdicts on the laws.

``columns``      the columns of a text file, as people and instruments write them
``experiment``   a text file of measured impacts, and those that belong to the package (``data``)
``flights``      speeds and restitution from heights or from times of impacts, with air drag
``curves``       restitution and contact time over the impact speed, for each contact law
``law_fit``      the parameter of one law from measured impacts, with its interval
``fit``          all laws from measured impacts and contact times, ranked
``verdicts``     is a law compatible with an experiment? By leaving out points; r where none is
"""
