"""Kinds of figures."""

from typing import Any, NamedTuple


class Kind(NamedTuple):
    """A kind of figure.

    Attributes
    ----------
    draw : str
        Module in microslip.report.figures and its drawing function, as "module.function"; empty for
        a page.
    study : str
        Study whose dataset is drawn; empty for figures of sweeps.
    run : dict
        Default settings of the single run that is drawn; empty if sweeps or studies are drawn.
    """

    draw: str
    study: str = ""
    run: dict[str, Any] = {}


_SIZES = {"cells": None, "steps": None}
_FIRST = {"velocity": 0.1, "amplitude": 1.0, "periods": 4, **_SIZES}
_APPROACH = {"velocity": 0.8, "travel": 5.0, **_SIZES}
KINDS = {
    "history": Kind("runs.history", run=_FIRST),
    "map": Kind("maps.draw"),
    "field": Kind("runs.field", run={"velocity": 0.5, "cells": None}),
    "curves": Kind("curves.draw"),
    "transients": Kind("runs.transients", run=_APPROACH),
    "explorer": Kind(""),
    "accuracy_profile": Kind("studies.profile", "accuracy"),
    "accuracy_vs_cost": Kind("studies.versus_cost", "accuracy"),
    "accuracy_vs_work": Kind("studies.versus_work", "accuracy"),
    "model_map": Kind("studies.model_map", "accuracy"),
    "stability_atlas": Kind("studies.atlas", "stability"),
    "claims_static": Kind("studies.static", "claims"),
    "claims_patches": Kind("studies.patches", "claims"),
}
"""All kinds of figures, keyed by name."""
