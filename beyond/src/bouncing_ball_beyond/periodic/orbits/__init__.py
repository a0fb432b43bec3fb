"""What a periodic orbit is, for any model: its equations, its stability, its special cases.

In reading order:

``balls``         balls whose parameters are known by name, so that any of them can vary
``stability``     the monodromy, its multipliers, and the stability that follows
``legs``          one leg of an orbit: a contact, and the flight after it
``highest``       the highest points in flight and within a contact
``beside``        the legs at points and beside them, and the derivatives that follow
``steps``         the steps of branches and of Newton's method
``problem``       the equations of an orbit with k impacts in m periods of the table
``lost_release``  where a contact no longer opens
``halves``        orbits that repeat after half their period
``special``       all special orbits, and the functions that vanish there
``ends``          the ends of a branch, each with the reason in words
``simulation``    from a simulated ball to an orbit, and whether a ball follows an orbit
``impacts``       the impacts of orbits as a row, and the equations that they solve
``motion``        the motion on an orbit: contacts, flights, the highest point
``orbit``         an orbit of any model, or an array of orbits, for a user
``saved``         orbits in datasets, from which they come back with the same bits
``return_map``    the return map next to an orbit, with its derivative
``normal_form``   whether a bifurcation is supercritical, by its normal form
"""
