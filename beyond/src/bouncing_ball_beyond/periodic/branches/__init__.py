"""Branches of periodic orbits of any model, along one parameter or two.

In reading order:

``following``       a branch along one parameter, up to a value or an end
``closed``          branches that come back to their start, and starts that are special orbits
``grazing``         from a grazing flight to the branch with one impact more
``switching``       from one branch to another, and the two sides of a saddle-node
``sticking_curve``  the end of sticking in two parameters
``curves``          curves of special orbits in two parameters
``observables``     the quantities of orbits, as datasets have them
``labelled``        branches and curves as records, and as datasets that have their orbits
``follow``          ``follow``, which a user calls
"""
