"""Branches of periodic orbits of any model, along one parameter or two.

In reading order:

``following``    a branch along one parameter, up to a value or an end
``switching``    from one branch to another, and the two sides of a saddle-node
``curves``       curves of special orbits in two parameters
``observables``  the quantities of orbits, as datasets have them
``labelled``     branches and curves as datasets that iterate and draw themselves
``follow``       ``follow``, which a user calls
"""
