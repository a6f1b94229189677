"""Friction of real contacts under vibration, in SI units.

    import microslip

    prediction = microslip.predict(
        "transverse", young="210 GPa", nu=0.3, counterbody="rigid", radius="5 mm", load="10 N",
        mu=0.3, speed="1 mm/s", amplitude="1 um", frequency="20 kHz",
    )
    print(prediction.mu_apparent, prediction.force_reduction, prediction.warnings)

`inputs` contains the table of the inputs and their checks.  `output` contains the table of the
outputs, and the class `Prediction`, which writes them in several formats.  `contact` computes the
dimensionless groups.  `solve` computes the dimensionless result, and finds the amplitude, speed or
load for a requested reduction of friction.  `predict` converts the result to SI units.  `uncertain`
propagates the uncertainty of the inputs.  `warnings` checks whether the theory applies.  `table`
predicts many contacts.  `response` and `strokes` read measured paths and motions.  `fit` and `fold`
evaluate measurements.
"""
