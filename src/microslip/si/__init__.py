"""Friction of real contacts under vibration, in SI units.

    import microslip

    prediction = microslip.predict(
        "transverse", young="210 GPa", nu=0.3, counterbody="rigid", radius="5 mm", load="10 N",
        mu=0.3, speed="1 mm/s", amplitude="1 um", frequency="20 kHz",
    )
    print(prediction.mu_apparent, prediction.force_reduction, prediction.warnings)

`quantities` reads texts with units, and `inputs` reads the bodies, the contact, the motion and the
drive.  `request` makes these inputs dimensionless and calls the solver.  `reduction` searches for a
missing amplitude, speed or load.  `static_limit` computes the force threshold.  `drive_result`
computes the friction or the drift.  `predict` returns the answers in a record defined by
`prediction`.  `uncertain` and `outcomes` propagate the uncertainty of the inputs.  `validity`
contains the limits of the theory.
"""
