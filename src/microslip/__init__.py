"""Friction of vibrated contacts, computed by a boundary element method.

``solve`` computes the friction for one velocity and amplitude.  ``history`` computes the forces at
every time step.  ``traction_field`` computes the tractions in a steady motion.  Importing the
package is fast, because each module is loaded only when one of its names is first used.
"""

from importlib import import_module as _import_module
from typing import Any as _Any

from microslip.foundation import accessor as _accessor

_WHERE = {
    "solve": "microslip.answer.point",
    "Result": "microslip.answer.answer",
    "Estimate": "microslip.answer.answer",
    "Effort": "microslip.periodic.run",
    "Problem": "microslip.scene.problem",
    "Motion": "microslip.scene.motion",
    "Transverse": "microslip.scene.named",
    "Longitudinal": "microslip.scene.named",
    "Zigzag": "microslip.scene.named",
    "Bore": "microslip.scene.named",
    "ContinuousBore": "microslip.scene.named",
    "Elliptic": "microslip.scene.named",
    "Normal": "microslip.scene.named",
    "TransverseBore": "microslip.scene.named",
    "Force": "microslip.scene.problem",
    "Spring": "microslip.scene.problem",
    "Sampled": "microslip.scene.samples",
    "Pressure": "microslip.scene.pressure",
    "Hertz": "microslip.scene.hertz",
    "Power": "microslip.scene.indenters",
    "Punch": "microslip.scene.indenters",
    "Ring": "microslip.scene.hertz",
    "Ellipse": "microslip.scene.hertz",
    "InputError": "microslip.foundation.errors",
    "warm_up": "microslip.answer.point",
    "predict": "microslip.si.predict",
    "predict_table": "microslip.si.table",
    "predict_grid": "microslip.si.table",
    "Material": "microslip.si.materials",
    "fit": "microslip.si.fit",
    "Fit": "microslip.si.fit",
    "to_xarray": "microslip.datasets.of_records",
    "open_map": "microslip.datasets.open_map",
    "texts": "microslip.datasets.netcdf",
    "history": "microslip.answer.along",
    "History": "microslip.answer.along",
    "traction_field": "microslip.answer.period",
    "propulsion": "microslip.answer.propulsion",
    "response": "microslip.answer.along",
    "Response": "microslip.answer.along",
    "predict_response": "microslip.si.response",
    "RealResponse": "microslip.si.response",
    "fold": "microslip.si.fold",
    "Fold": "microslip.si.fold",
    "iwan": "microslip.answer.along",
    "Iwan": "microslip.theory.masing",
    "predict_iwan": "microslip.si.response",
    "shakedown": "microslip.answer.force",
    "Shakedown": "microslip.answer.force",
    "Propulsion": "microslip.answer.propulsion",
    "period": "microslip.answer.period",
    "Period": "microslip.answer.period",
}
_accessor.register()
__all__ = sorted(_WHERE)
__version__ = "0.1.0"


def __dir__() -> list[str]:
    """List all public names, including those whose modules are not imported yet."""
    return sorted({*globals(), *_WHERE})


def __getattr__(name: str) -> _Any:
    if name in _WHERE:
        value = globals()[name] = getattr(_import_module(_WHERE[name]), name)
        return value
    raise AttributeError(f"module 'microslip' has no attribute {name!r}")
