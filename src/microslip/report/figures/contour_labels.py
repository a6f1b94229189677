"""Numbers on contours: straight on their line, inside the frame, and off all other lines."""

from __future__ import annotations

from collections.abc import Iterable, Iterator

import numpy as np
from matplotlib.axes import Axes
from matplotlib.contour import ContourSet

from microslip.report.figures import style as look

CLEAR, STEP = 2.0, 2.0
"""Distances in points of length: between a number and the frame or another line, and between places
that are tried."""
STRAIGHT = 1.04
"""A line is straight enough under a number where the way between its ends is no longer than this
times their distance."""


def label(axes: Axes, contours: ContourSet, levels: Iterable[float], size: float) -> None:
    """Write the number of each of these levels once on its contour.

    It stands where the line is straightest, towards its middle; where nothing is free, the number
    is left out, and the colours tell what the line is. To be called when the panel has its place.
    """
    point = axes.figure.dpi / 72.0
    lines = {float(level): _lines(axes, contours, k) for k, level in enumerate(contours.levels)}
    width = look.measurer(size)
    taken: list[np.ndarray] = []
    for level in levels:
        text = f"{level:.1f}".replace("-0.0", "0.0")
        box = np.array([width(text) * axes.figure.dpi, size * point]) / 2 + CLEAR * point
        others = [line for other, own in lines.items() if other != level for line in own]
        places = [
            (score, place, turn)
            for line in lines[float(level)]
            for score, place, turn in _places(line, box, STEP * point)
        ]
        obstacles = np.concatenate([np.empty((0, 2)), *others, *taken])
        for _, place, turn in sorted(places, key=lambda found: found[0]):
            if _inside(axes, place, turn, box) and not _within(obstacles, place, turn, box).any():
                at = axes.transData.inverted().transform(place)
                # The nearest contour is labelled.  All levels are candidates, since Matplotlib 3.10
                # looks a level up by a wrong index in a list of some of them.
                contours.clabel(fmt=text, fontsize=size, inline_spacing=2, manual=[tuple(at)])
                taken.append(_grid(place, turn, box))
                break


def _lines(axes: Axes, contours: ContourSet, index: int) -> list[np.ndarray]:
    """The lines of a level in pixels, with points closer than a number is high."""
    # Transformed first: to_polygons leaves out points that differ by less than one unit.
    path = axes.transData.transform_path(contours.get_paths()[index])
    lines = []
    for polygon in path.to_polygons(closed_only=False):
        pixels = np.asarray(polygon)
        way = np.append(0.0, np.cumsum(np.hypot(*np.diff(pixels, axis=0).T)))
        if way[-1] > 0:
            even = np.linspace(0.0, way[-1], max(2, int(way[-1]) + 1))
            lines.append(np.column_stack([np.interp(even, way, x) for x in pixels.T]))
    return lines


def _places(
    line: np.ndarray, box: np.ndarray, step: float
) -> Iterator[tuple[float, np.ndarray, float]]:
    """Places on a line with room for a box: a score that is less for better ones, middle, turn."""
    reach = int(np.ceil(box[0]))
    for middle in range(reach, len(line) - reach, max(1, int(step))):
        ends = line[middle - reach], line[middle + reach]
        across = ends[1] - ends[0]
        bend = 2 * reach / max(np.hypot(*across), 1e-9)
        if bend <= STRAIGHT:
            turn = np.arctan(across[1] / across[0]) if across[0] else np.pi / 2
            away = abs(middle / len(line) - 0.5)
            yield away + 5.0 * (bend - 1.0), line[middle], turn


def _turned(points: np.ndarray, place: np.ndarray, turn: float) -> np.ndarray:
    """Points in the directions of a box that is turned."""
    c, s = np.cos(turn), np.sin(turn)
    return (points - place) @ np.array([[c, -s], [s, c]])


def _within(points: np.ndarray, place: np.ndarray, turn: float, box: np.ndarray) -> np.ndarray:
    """Which points lie in a box around a place; box: its half width and half height."""
    return (np.abs(_turned(points, place, turn)) < box).all(axis=1)


def _grid(place: np.ndarray, turn: float, box: np.ndarray) -> np.ndarray:
    """Points all over a box, so close that no other box has room between them."""
    x, y = (np.linspace(-half, half, max(3, int(half))) for half in box)
    c, s = np.cos(turn), np.sin(turn)
    return place + np.stack(np.meshgrid(x, y), axis=-1).reshape(-1, 2) @ [[c, s], [-s, c]]


def _inside(axes: Axes, place: np.ndarray, turn: float, box: np.ndarray) -> bool:
    """Whether a box lies inside the panel."""
    c, s = abs(np.cos(turn)), abs(np.sin(turn))
    reach = np.array([box[0] * c + box[1] * s, box[0] * s + box[1] * c])
    frame = axes.get_window_extent()
    return bool((place - reach >= frame.min).all() and (place + reach <= frame.max).all())
