"""Iwan model of a real contact, in SI units."""

from __future__ import annotations

from microslip.answer.along import iwan
from microslip.foundation.errors import InputError
from microslip.si.response import only_contact
from microslip.theory.masing import Iwan


def predict_iwan(
    *, elements: int | None = None, tolerance: float | None = None, **contact: object
) -> Iwan:
    """Iwan model of a contact of two bodies: parallel springs with sliders, in SI units.

    Parameters
    ----------
    elements : int or None
        Number of elements.
    tolerance : float or None
        Largest error due to the number of elements, divided by mu times the load; give either this
        (1e-3) or `elements`.
    **contact : quantity
        mu, load, radius, material and the other arguments of `microslip.predict` that describe a
        contact.

    Returns
    -------
    Iwan
        Elements with stiffnesses in N/m and forces in N.

    Raises
    ------
    InputError
        If an argument is invalid.  The message names it.
    """
    real = only_contact(contact)
    try:
        model = iwan(real.pressure, poisson=real.poisson, elements=elements, tolerance=tolerance)
    except InputError as error:
        across = contact.get("radius_across")
        if error.argument != "pressure" or across is None:
            raise
        allowed = "allowed only if nu = 0, because the contact is an ellipse"
        raise InputError("radius_across", across, allowed) from None
    return model.scaled(real.mu * real.load, real.u_lim)
