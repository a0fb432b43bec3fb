"""Any periodic orbit, followed along any parameter.

``family`` names the parameters of balls, ``problem`` has the equations of an orbit with k impacts,
``special`` the events on a branch, ``following`` the branch, ``switching`` the ways from one branch
to another, and ``curves`` the curves in two parameters.
"""
