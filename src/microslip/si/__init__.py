"""Friction of real contacts under vibration, in SI units.

    import microslip

    prediction = microslip.predict(
        "transverse", young="210 GPa", nu=0.3, counterbody="rigid", radius="5 mm", load="10 N",
        mu=0.3, speed="1 mm/s", amplitude="1 um", frequency="20 kHz",
    )
    print(prediction.mu_apparent, prediction.force_reduction, prediction.warnings)

`inputs` is the table of the inputs, with their checks, and `output` the table of the outputs, with
all forms of a Prediction.  `contact` computes the dimensionless groups, and `solve` the
dimensionless answer, also for a missing amplitude, speed or load.  `predict` multiplies the answer
by its units, `uncertain` propagates the uncertainty of the inputs, and `warnings`
contains the limits of the theory.  `table` predicts many contacts.  `response` and `strokes` read
measured paths and motions.  `fit` and `fold` evaluate measurements.
"""
