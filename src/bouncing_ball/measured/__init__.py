"""Measured impacts: experiments, the contacts that are fitted to them, and verdicts on the laws.

``experiment``   a text file of measured impacts, and those that belong to the package (``data``)
``flights``      speeds and restitution from heights or from times of impacts, with air drag
``curves``       restitution and contact time over the impact speed, for each contact law
``fit``          the parameters of the laws from measured impacts, with intervals, ranked
``verdicts``     is a law compatible with an experiment? By leaving out points
"""
