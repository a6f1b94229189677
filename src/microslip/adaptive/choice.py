"""What to run: the least that is right for the scene and fine enough for the tolerance."""

from __future__ import annotations

from microslip.adaptive.chains import Axis
from microslip.foundation.errors import InputError
from microslip.models.registry import MODELS
from microslip.pressures.registry import HERTZ
from microslip.solver.method import SHIPPED
from microslip.solver.problem import Resolution
from microslip.solver.static_limit import at_turning_points
from microslip.theory import hertz
from microslip.theory.catalogue import FORMS, LARGEST_DROPS, STATIC

STEPLESS = ("rigid", "dahl")
"""Models whose march is an evaluation: no step of theirs is solved."""
RINGS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256)
SQUARES = (8, 16, 32, 64, 128)
STATIC_SQUARES = (16, 24, 32, 48, 64, 96, 128, 192)
ANGLES = (2, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96)
STEPS = (4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128, 192, 256, 384, 512, 768)
"""Levels: rings (squares along a side), angles on half the disc, steps in half a period."""
BASE_RINGS, BASE_ANGLES, BASE_STEPS = 8, 6, 16
SLOW_CREEP = 3e-3
"""Creep in a radian (u_lim) below which the layer at the stick radius is thin: the coarsest rings
agree with each other there before they see it, and prove nothing."""
SWEEPING_CENTRE = (0.1, 1.0)
"""Velocities of a bore at which the centre of rotation sweeps through the contact and stays in it
for a good part of the period: the coarsest rings agree there, too, without having seen it."""
TURNING_CAUTION = 2.0
"""Error in time over the spread of the runs where the contact turns or slides back: the first step
after a turning point, in which all points stick and slip again, errs to one side whatever its
length."""
SWEEPING_STEPS = 4
"""Steps in half a period over rings where the edge of the contact sweeps over these.  They join it
one by one, and the error scatters unless both are refined together."""
SWEEPING_CAUTION = 1.5
EDGE_CAUTION = 1.25
"""Error over the spread of four runs where each gathers its rings at a stick radius that it finds
by itself, to the width of a ring."""
LONGEST_STROKE = 16.0
"""Stroke in u_lim beyond which more steps are left to the estimate of the error."""
QUADRATURE = 1e-7
"""Error of Eqs 17 and 18 for another pressure, which may have kinks."""
WHOLE_ROUNDING = 1e-9
OF_RECORD = 1e-8
"""Error of closed forms by quadrature: of a whole motion, and of what follows from the record of an
indenter's pressure."""
ROUNDING = 1e-12


def choose_model(scene, poisson, model="auto"):
    """The model to use: the cheapest that is exact for the scene, or the one asked for.

    Rings where the traction depends on the radius alone (translation at nu = 0), angular modes
    where half of the contact tells the other half: squares are never cheaper then.  The slider
    and the rigid contact are never chosen: what they leave out can only be bounded by running the
    rings, which then are the answer.  Raises InputError for an unknown model or one that does not
    apply.
    """
    if model == "auto":
        if not (scene.pressure.is_round and scene.half_disc):
            name = "cartesian"
        else:
            name = "polar" if scene.rotates or poisson > 0.0 else "radial"
        refusal = MODELS[name].refuses(scene, poisson)
        if refusal:
            why = f"only {name} could resolve it, and {refusal}"
            if scene.pressure is HERTZ and poisson == 0.0:
                raise InputError("scene", scene.name, why)
            given = ("poisson", poisson)
            if scene.pressure is not HERTZ:
                given = ("pressure", scene.pressure.name)
            raise InputError(*given, f"does not go with {scene.name}: {why}")
        return name
    if not isinstance(model, str) or model not in MODELS:
        raise InputError("model", model, f"allowed is one of auto, {', '.join(MODELS)}")
    refusal = MODELS[model].refuses(scene, poisson)
    if refusal:
        raise InputError("model", model, f"does not apply to {scene.name}: {refusal}")
    return model


def method_refusal(scene, model, method):
    """Why a method.Method has no part in how a model (by name) computes a scene, as one line; "" if
    it has."""
    if method.run is not None:
        if model != method.model:
            return f"it is a run of the model {method.model}"
        if not scene.periodic:
            return "nothing oscillates"
        if scene.depth is not None:
            return "it knows a constant normal load alone"
        return "it knows translations alone" if scene.rotates and not method.turns else ""
    if method == SHIPPED:
        return ""
    if scene.depth is not None and (method.dress is not None or method.integrator.end < 1.0):
        return "its steps know one friction bound"
    if model in STEPLESS:
        return "no step of the model has to be solved"
    if not scene.periodic and method.dress is None:
        return "nothing oscillates"
    if model == "cartesian" and method.dress is not None:
        return "the matrix of all squares would be too large"
    return ""


def no_vibration(scene, amplitude):
    """(mu, torque, error) where nothing oscillates, whatever the model, else None."""
    return (1.0, None, ROUNDING) if scene.periodic and amplitude == 0.0 else None


def closed_form(scene, velocity, amplitude, poisson, tolerance):
    """(mu, torque, error) where nothing has to be computed, else None.

    The steady state of a motion that does not oscillate, where every point slips along its rigid
    velocity; the limit of vanishing velocity; motion along one line, nu = 0; and sliding so fast
    that the bracket of bounds.py is within the tolerance.
    """
    if not scene.periodic:
        return _steady(scene, velocity)
    if scene.whole is not None and poisson == 0.0:
        whole = scene.whole(velocity, amplitude, scene.pressure)
        if whole is not None:
            error = WHOLE_ROUNDING if velocity > 0.0 else ROUNDING
            return float(whole), None, error if scene.pressure.hertzian else OF_RECORD
    if velocity == 0.0:
        known = None if scene.whole is not None else FORMS.get(scene.name, {}).get(STATIC)
        if known is None or (poisson > 0.0 and not known.any_poisson):
            return None
        return _static(scene, known.function, amplitude, poisson)
    largest_drop = LARGEST_DROPS.get(scene.name)
    if largest_drop is not None and not (scene.rotates and scene.pressure is not HERTZ):
        drop = largest_drop(velocity, amplitude)
        if 0.5 * drop + ROUNDING <= tolerance:
            return 1.0 - 0.5 * drop, None, 0.5 * drop + ROUNDING
    return None


def _steady(scene, velocity):
    """Eqs 17 and 18; 21 and 22 for a sphere."""
    if scene.pressure is HERTZ:
        forward, torque = (form.function(velocity) for form in FORMS[scene.name].values())
        return float(forward), float(torque), ROUNDING
    if not scene.pressure.is_round:
        return None
    from microslip.theory import axisymmetric  # only now: integration takes a while to load

    forward, torque = axisymmetric.bore_of(scene.pressure.bound, velocity)
    return float(forward), float(torque), QUADRATURE


def _static(scene, of_sphere, amplitude, poisson):
    """The limit of vanishing velocity, if it has a closed form under this pressure."""
    pressure = scene.pressure
    if pressure is HERTZ or (pressure.hertzian and not scene.rotates):
        return float(of_sphere(amplitude)), None, ROUNDING
    if not pressure.is_indenter:
        return None
    from microslip.theory import indenters as limits  # only now, as above

    if scene.rotates:
        mu = limits.static_bore(pressure, float(hertz.bore_angle(amplitude, poisson)), poisson)
    else:
        mu = limits.static_transverse(pressure, amplitude)
    return mu, None, OF_RECORD


def plan(scene, name, velocity, amplitude, poisson, tolerance, cells=None, steps=None):
    """Resolution of what is not refined, and the axes to refine (see refinement.certify).

    name: of the model; cells, steps (in a full period): impose a resolution instead.
    """
    resolved, axes = MODELS[name].axes(scene), []
    marches = scene.periodic and (velocity > 0.0 or not at_turning_points(scene))
    sweeps = scene.depth is not None and marches and cells is None and steps is None
    if sweeps:
        axes.append(_sweeping(scene, amplitude, poisson, tolerance))
    elif "cells" in resolved:
        axes.append(_cells(scene, name, velocity, amplitude, poisson, cells))
    if "angles" in resolved:
        # only nu > 0 makes tractions of a translation depend on the angle, and only a little
        base = ANGLES.index(BASE_ANGLES) + (not scene.periodic) - (not scene.rotates)
        axes.append(Axis("angles", ANGLES, base, (base - 1, base, base + 1)))
    if marches and not sweeps:
        axes.append(_steps(scene, amplitude, poisson, tolerance, steps))
    return Resolution(cells=1, angles=1, steps=STEPS[0]), tuple(axes)


def _cells(scene, name, velocity, amplitude, poisson, imposed):
    if imposed is not None:
        return _imposed("cells", imposed)
    if name == "cartesian":  # doubled, since cells come and go at the edge
        if velocity == 0.0:  # nothing is marched, so more of them are cheap; as below for rings
            return Axis("cells", STATIC_SQUARES, 2, (0, 1, 2, 3, 4))
        base = 2 if _is_slow(scene, velocity, amplitude, poisson) else 1
        return Axis("cells", SQUARES, base, (base - 1, base, base + 1), regular=True)
    base = RINGS.index(BASE_RINGS)
    if name == "mdr":  # springs know nothing of each other, and slip one by one
        return Axis("cells", RINGS, base + 2, (base + 1, base + 2, base + 3))
    if not scene.periodic:  # the centre of rotation stays where it is, and only fine rings see it
        return Axis("cells", RINGS, base + 1, (base, base + 1, base + 2), regular=True)
    if velocity == 0.0 and not at_turning_points(scene):  # each run finds the edge by itself
        return Axis(
            "cells", RINGS, base + 3, tuple(range(base + 2, base + 6)), caution=EDGE_CAUTION
        )
    if velocity == 0.0:  # a stick zone that is not circular cuts rings, and the corners are steep
        return Axis("cells", RINGS, base + 2, tuple(range(base, base + 6)))
    if scene.rotates:
        slow = _is_slow(scene, velocity, amplitude, poisson)
        up = 1 if slow or SWEEPING_CENTRE[0] <= velocity < SWEEPING_CENTRE[1] else 0
    else:  # few unknowns; and at nu > 0 the front of slip is oval, which rings are not
        up = 2 if poisson > 0.0 else 1
    base, last = base + max(up - 1, 0), base + up
    return Axis("cells", RINGS, base, (last - 2, last - 1, last), regular=True)


def _is_slow(scene, velocity, amplitude, poisson):
    """Whether the layer at the stick radius is thin."""
    return scene.periodic and 0.0 < scene.creep(velocity, amplitude, poisson) < SLOW_CREEP


def _imposed(name, count):
    """An axis whose resolution is asked for; two coarser ones show what it is worth."""
    levels = (count // 2, round(0.75 * count), count)
    return Axis(name, levels, 2, (0, 1, 2), imposed=True)


def _sweeping(scene, amplitude, poisson, tolerance):
    """Steps and rings together."""
    rings = RINGS[RINGS.index(BASE_RINGS) :]
    levels = _step_levels(scene, amplitude, poisson, [SWEEPING_STEPS * count for count in rings])
    base = 1 if tolerance >= 5e-3 else 2
    first = tuple(range(base - 1, base + 3))
    return Axis("steps", levels, base, first, caution=SWEEPING_CAUTION, tied=("cells", rings))


def _step_levels(scene, amplitude, poisson, counts):
    """Even numbers of steps that stay short against u_lim where the stroke is long."""
    stroke = min(max(1.0, scene.stroke(amplitude, poisson)), LONGEST_STROKE)
    return tuple(2 * round(0.5 * count * scene.cycles * stroke**0.5) for count in counts)


def _steps(scene, amplitude, poisson, tolerance, imposed):
    if imposed is not None:
        return _imposed("steps", imposed // 2)
    levels = _step_levels(scene, amplitude, poisson, STEPS)
    # second order in time
    wanted = BASE_STEPS * max(1.0, (1e-3 / tolerance) ** 0.5)
    base = next(k for k, count in enumerate(STEPS) if count >= wanted)
    turns = scene.rotates or not scene.half_period_mirror
    caution = TURNING_CAUTION if turns else 1.0
    return Axis("steps", levels, base, (base - 2, base - 1, base), caution=caution)
