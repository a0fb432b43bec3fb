"""Any periodic orbit, followed along any parameter.

The modules in reading order, first what an orbit is:

``balls``         balls whose parameters are known by name, so that any of them can vary
``legs``          one leg of an orbit: a contact, and the flight after it
``products``      the monodromy of an orbit as a product of the matrices of its legs
``problem``       the equations of an orbit with k impacts in m periods of the table
``orbit``         an orbit of any model, or an array of orbits
``stability``     the linear stability of a fixed point of a planar map
``simulation``    from a simulated ball to an orbit, and whether a ball follows an orbit

Branches of any model:

``special``       the special orbits on a branch
``release``       one of them, the grazing of a release
``lost_release``  another one, at which a contact no longer opens and the branch ends
``following``     a branch along one parameter, up to a value or an end
``switching``     from one branch to another, and the two sides of a saddle-node
``curves``        curves of special orbits in two parameters
``labelled``      branches and curves as datasets that iterate and draw themselves
``follow``        ``follow``, ``switch`` and ``curve``, which a user calls

Orbits with one impact in n periods:

``n_t``                          the orbits of any model, their saddle-nodes and period doublings
``closed_forms``                 in which models they have a closed form
``restitution_branch``           that of the restitution model
``corrected_branch``             that of the corrected model
``spring_damper_branch``         the explicit curve of the spring-damper model
``spring_damper_bifurcations``   the bifurcations on this curve, and its orbits at a given Λ
``start``                        where the branch of a model without a closed form begins
``law_at_orbit``                 the contact law that has a given r and D at its orbit
``paper_unknowns``               the equations in the unknowns of the paper
``branch``                       a whole branch, from one end to the other

Calls for balls with arrays of parameters:

``places``             results at each place of the grid of the arguments
``observables``        the quantities of orbits, as datasets have them
``orbits_of_ball``     an orbit, all orbits at an amplitude, and the limits of a family
``branches_of_ball``   whole branches over Λ
"""
