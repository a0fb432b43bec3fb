"""Any periodic orbit, followed along any parameter.

``family`` names the parameters of balls, ``legs`` has a contact with the flight after it,
``problem`` the equations of an orbit with k impacts, ``products`` the monodromy as a product over
the legs, ``simulation`` the way from a simulated ball to an orbit and back, ``special`` the events
on a branch, ``release`` the one at which a contact opens, ``following`` the branch, ``switching``
the ways from one branch to another, and ``curves`` the curves in two parameters.
"""
