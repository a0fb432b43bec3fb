"""Any periodic orbit, followed along any parameter.

The rooms in reading order, each of which imports only those before it:

``orbits``      what an orbit is: its equations, its stability, its special cases
``branches``    orbits that are followed along a parameter, and curves in two parameters
``one_impact``  n-T orbits: closed forms, their bifurcations, whole branches

Calls for balls with arrays of parameters:

``law_balls``          balls on contacts of other laws than the linear one
``places``             results at each place of the grid of the arguments
``orbits_of_ball``     an orbit, all orbits at an amplitude, and the limits of a family
``branches_of_ball``   whole branches over Λ
``read_orbits``        saved results, with their figures and their orbits
"""
