"""The angular functions of each sector: what the symmetries of a motion leave of the modes.

Sectors and folded parts are those of angular_modes.py.
"""

from __future__ import annotations

import numpy as np

EVEN_FORWARD, ODD_LATERAL, ODD_FORWARD, EVEN_LATERAL = range(4)
"""Order of the folded parts: sectors are neighbours in memory."""


def waves(angles: int, rotates: bool, coupled: bool) -> list[list[tuple]]:
    """Angular functions, each as (key, folded parts (4, M/2)), grouped by sector.

    key (m, part) names the mode: at nu > 0 the complex wave e^{i m theta} of forward - i lateral
    times 1 (part 0) or i (part 1); at nu = 0 a cosine (part 0) or sine (part 1) of one component.
    Part 2: the shortest sine, which has no cosine beside it.
    """
    half = angles // 2
    theta = (np.arange(half) + 0.5) * np.pi / angles
    if not coupled:
        found = _single_waves(theta, angles, rotates)
    elif rotates:
        found = _rotating_waves(theta, angles)
    else:
        found = _translating_waves(theta, angles)
    groups = [[] for _ in range(2 if coupled else 4)]
    for key, parts in found:
        folded = np.zeros((4, half))
        for part, values in parts.items():
            folded[part] = values
        first = next(iter(parts))
        groups[first // 2 if coupled else first].append((key, folded))
    return groups


def _single_waves(theta, angles, rotates):
    """At nu = 0: each folded part by itself; yields (key, {part: values}).

    Where the contact rotates, forward tractions are cosines and lateral ones sines; translations
    have both of each, but even modes only.
    """
    step = 1 if rotates else 2
    for m in range(0, angles, step):
        cosine = np.exp(1j * m * theta).real
        yield (m, 0), {EVEN_FORWARD if m % 2 == 0 else ODD_FORWARD: cosine}
        sine = np.sin((m + step) * theta)
        yield (m + step, 1), {EVEN_LATERAL if (m + step) % 2 else ODD_LATERAL: sine}
        if not rotates:
            yield (m + step, 1), {ODD_FORWARD: sine}
            yield (m, 0), {EVEN_LATERAL: cosine}


def _rotating_waves(theta, angles):
    """At nu > 0 where the mirror theta -> -theta leaves real amplitudes, as `_single_waves`."""
    for m in range(1 - angles, angles):
        yield (m, 0), _of_wave(np.exp(1j * m * theta), m % 2 == 0)
    yield (angles, 2), _of_wave(1j * np.sin(angles * theta), angles % 2 == 0)


def _translating_waves(theta, angles):
    """At nu > 0 where the symmetry about the centre leaves even modes, as `_single_waves`."""
    first = -(angles // 2) + (1 - angles % 2)
    for k in range(first, first + angles):
        wave = np.exp(2j * k * theta)
        yield (2 * k, 0), _of_wave(wave, True)
        yield (2 * k, 1), _of_wave(wave * 1j, False)


def _of_wave(wave, even):
    """Folded parts of a wave of forward - i lateral whose forward part is even or odd."""
    forward, lateral = (EVEN_FORWARD, ODD_LATERAL) if even else (ODD_FORWARD, EVEN_LATERAL)
    return {forward: wave.real, lateral: -wave.imag}
