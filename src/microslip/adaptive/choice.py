"""Choice of the contact model, and of the methods that apply to it."""

from __future__ import annotations

from microslip.contact.registry import MODELS
from microslip.foundation.errors import InputError
from microslip.motions.problem import Problem
from microslip.pressures.hertz import HERTZ
from microslip.solver.method import SHIPPED, Method

STEPLESS = ("rigid", "dahl")
"""Models that evaluate a formula at every step, without a step solver."""


def choose_model(problem: Problem, model: str = "auto") -> str:
    """Return the name of the model: the cheapest exact model for "auto", otherwise `model`.

    Rings are chosen if the traction depends only on the radius (translation at nu = 0).  Angular
    modes are chosen for other motions of a round contact, and squares in all other cases.  Squares
    are also chosen for the static limit of a contact without symmetry, because its stick zone is
    not round.  The slider and the rigid contact are never chosen.  Bounding their model error would
    need a run of the rings, which already gives the result.

    Parameters
    ----------
    problem : problem.Problem
        The problem.  At velocity 0 without a drive, the result is the static limit.
    model : str
        "auto", or a name in contact.registry.MODELS.

    Raises
    ------
    InputError
        If the model is unknown or does not apply.
    """
    if not isinstance(model, str) or model not in ("auto", *MODELS):
        raise InputError("model", model, f"allowed is one of auto, {', '.join(MODELS)}")
    motion = problem.motion
    if model == "auto":
        static = problem.velocity == 0.0 and problem.drive is None and motion.periodic
        by_squares = static and not motion.loads and not motion.half_disc
        if by_squares or not problem.pressure.is_round:
            name = "cartesian"
        else:
            name = "polar" if motion.rotates or problem.poisson > 0.0 else "radial"
        refusal = MODELS[name].refuses(problem)
        if refusal:
            why = f"only {name} could resolve it, and {refusal}"
            if problem.pressure == HERTZ and problem.poisson == 0.0:
                raise InputError("motion", motion.name, why)
            argument: tuple[str, object] = ("poisson", problem.poisson)
            if problem.pressure != HERTZ:
                argument = ("pressure", problem.pressure.name)
            raise InputError(*argument, f"does not go with {motion.name}: {why}")
        return name
    refusal = MODELS[model].refuses(problem)
    if refusal:
        raise InputError("model", model, f"does not apply to {motion.name}: {refusal}")
    return model


def method_refusal(problem: Problem, model: str, method: Method) -> str:
    """Reason why a method does not apply to a model and a motion; empty if it applies."""
    motion = problem.motion
    if method.run is not None:
        if model != method.model:
            return f"it is a run of the model {method.model}"
        if not motion.periodic:
            return "nothing oscillates"
        if motion.loads:
            return "it supports a constant normal load only"
        return "it supports translations only" if motion.rotates and not method.turns else ""
    if method == SHIPPED:
        return ""
    if motion.loads and (method.dress is not None or method.integrator.end < 1.0):
        return "its steps support a constant friction bound only"
    if model in STEPLESS:
        return "the model has no steps to solve"
    if not motion.periodic and method.dress is None:
        return "nothing oscillates"
    if model == "cartesian" and method.dress is not None:
        return "the matrix of all squares would be too large"
    return ""
