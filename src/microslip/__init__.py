"""Friction of a vibrated Hertz contact, resolved by boundary elements.

``solve`` answers for one point, ``solve_stored`` keeps the answer, ``history`` and
``traction_field`` show what happens inside.  The solver is imported when it is first asked for, so
that importing the package costs next to nothing.
"""

from importlib import import_module as _import_module

from microslip import source_digest as _source_digest  # noqa: F401  reads what will be loaded

_WHERE = {
    "solve": "microslip.point",
    "Result": "microslip.point",
    "warm_up": "microslip.point",
    "solve_stored": "microslip.stored",
    "predict": "microslip.si.predict",
    "open_map": "microslip.query",
    "history": "microslip.inside",
    "History": "microslip.inside",
    "traction_field": "microslip.inside",
    "period": "microslip.inside",
    "Period": "microslip.inside",
}
__all__ = sorted(_WHERE)
__version__ = "0.1.0"


def __dir__():
    """Names for completion: those that are imported when they are first asked for, too."""
    return sorted({*globals(), *_WHERE})


def __getattr__(name):
    if name in _WHERE:
        return getattr(_import_module(_WHERE[name]), name)
    raise AttributeError(f"module 'microslip' has no attribute {name!r}")
