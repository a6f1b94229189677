"""From a real contact in SI units to its friction under vibration.

    import microslip

    found = microslip.predict(
        "transverse", young="210 GPa", nu=0.3, counterbody="rigid", radius="5 mm", load="10 N",
        mu=0.3, speed="1 mm/s", amplitude="1 um", frequency="20 kHz",
    )
    print(found.mu_apparent, found.force_reduction, found.warnings)

The way of a request: `quantities` reads texts with units, `inputs` the bodies, the contact, the
motion and the drive.  `request` holds them, makes them dimensionless and calls the solver.
`reduction` looks for a missing amplitude, speed or load, `static_limit` computes the force
threshold, and `pulled` the friction or the drift.  `predict` turns the answers into a record of
`prediction`, and `uncertain` and `outcomes` add the uncertainty that follows from the inputs.
`validity` has the limits of the theory.
"""
