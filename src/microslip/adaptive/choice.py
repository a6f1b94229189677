"""The model to use and where a method has a part: the least that is right for the motion."""

from __future__ import annotations

from microslip.foundation.errors import InputError
from microslip.models.registry import MODELS
from microslip.motions.motion import Motion
from microslip.pressures.by_name import HERTZ
from microslip.solver.method import SHIPPED, Method

STEPLESS = ("rigid", "dahl")
"""Models whose march is an evaluation: no step of theirs is solved."""


def choose_model(
    motion: Motion, poisson: float, model: str = "auto", *, static: bool = False
) -> str:
    """The model to use: the cheapest that is exact for the motion, or the one asked for.

    Rings where the traction depends on the radius alone (translation at nu = 0), angular modes
    where the contact is round besides: squares are never cheaper then, but for the static limit of
    a contact that no symmetry halves, where the edge of what sticks cuts rings, and nothing is
    marched.  The slider and
    the rigid contact are never chosen: what they leave out can only be bounded by running the
    rings, which then are the answer.

    Parameters
    ----------
    motion : motion.Motion
        What moves.
    poisson : float
        Poisson's ratio.
    model : str
        "auto", or a name in models.registry.MODELS.
    static : bool
        Whether the limit of vanishing velocity is asked for.

    Raises
    ------
    InputError
        For an unknown model or one that does not apply.
    """
    if not isinstance(model, str) or model not in ("auto", *MODELS):
        raise InputError("model", model, f"allowed is one of auto, {', '.join(MODELS)}")
    if model == "auto":
        by_squares = static and motion.depth is None and not motion.half_disc
        if by_squares or not motion.pressure.is_round:
            name = "cartesian"
        else:
            name = "polar" if motion.rotates or poisson > 0.0 else "radial"
        refusal = MODELS[name].refuses(motion, poisson)
        if refusal:
            why = f"only {name} could resolve it, and {refusal}"
            if motion.pressure is HERTZ and poisson == 0.0:
                raise InputError("motion", motion.name, why)
            given = ("poisson", poisson)
            if motion.pressure is not HERTZ:
                given = ("pressure", motion.pressure.name)
            raise InputError(*given, f"does not go with {motion.name}: {why}")
        return name
    refusal = MODELS[model].refuses(motion, poisson)
    if refusal:
        raise InputError("model", model, f"does not apply to {motion.name}: {refusal}")
    return model


def method_refusal(motion: Motion, model: str, method: Method) -> str:
    """Why a method has no part in how a model (by name) computes a motion, as one line; "" if it
    has."""
    if method.run is not None:
        if model != method.model:
            return f"it is a run of the model {method.model}"
        if not motion.periodic:
            return "nothing oscillates"
        if motion.depth is not None:
            return "it knows a constant normal load alone"
        return "it knows translations alone" if motion.rotates and not method.turns else ""
    if method == SHIPPED:
        return ""
    if motion.depth is not None and (method.dress is not None or method.integrator.end < 1.0):
        return "its steps know one friction bound"
    if model in STEPLESS:
        return "no step of the model has to be solved"
    if not motion.periodic and method.dress is None:
        return "nothing oscillates"
    if model == "cartesian" and method.dress is not None:
        return "the matrix of all squares would be too large"
    return ""
