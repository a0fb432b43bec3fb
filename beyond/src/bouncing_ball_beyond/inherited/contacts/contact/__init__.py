"""An engineer's contact: SI units in, a verdict or the settings of a physics engine out.

The way of a contact through the modules:

``contact``, ``table``, ``question``
    what a user gives: ``quantities`` says what each may be, and ``units`` reads each text once
``resolve``
    from the parameters to a :class:`~.resolved.ResolvedContact` (``resolved``): the dimensionless
    model and its SI scales. ``loss``, ``drop_test`` and ``hertz`` have the formulas,
    ``named_laws`` the contact laws by their names, and ``law_balls`` makes balls of them
``assess``
    is a restitution coefficient good enough? By the orbits in all models (``families``) and the
    motion on which most balls end (``motion``, ``starts``), with as many balls and impacts as take
    seconds (``effort``). ``judgement`` has what decides
``choose``
    how stiff must a contact be for that? By the ϖ that a tolerance needs (``needed``)
``describe``
    the numbers of a contact without a table; ``drops`` and ``rebounds`` have those of a drop
``numbers_of_contact``
    the numbers that the answers of ``assess``, ``choose`` and ``describe`` read from the contact
``verdict``, ``notes``, ``remarks``
    the sentences on these facts, written when they are shown: by the library, as text, JSON or page
``rows``, ``texts``, ``page_data``, ``page_figures``
    results as text, as JSON and on a page
"""
