"""From a real contact in SI units to its friction under vibration.

    import microslip

    found = microslip.predict(
        "transverse", young="210 GPa", nu=0.3, counterbody="rigid", radius="5 mm", load="10 N",
        mu=0.3, speed="1 mm/s", amplitude="1 um", frequency="20 kHz",
    )
    print(found.mu_apparent, found.force_reduction, found.warnings)

`quantities` reads texts with units, `materials` is a small table, `bodies` holds Hertz's theory for
two bodies, `dimensionless` makes the paper's groups, `drives` reads what pulls, `regimes` tells
what that is as good as, `predict` asks the solver, and `validity` tells where the theory breaks.
"""
