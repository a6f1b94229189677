"""Layout of the page of the atlas, in millimetres."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from microslip.report.figures import style as look

MM = 1 / 25.4
WIDTH, HEIGHT = 180.0, 248.0
MARGIN, GAP = 2.0, 4.0
SQUARE = (3.5, 5.5)  # narrowest and widest column
ROW = (2.65, 4.2)  # lowest and highest row
MOST_BESIDE = 6
SIZE = look.SMALLEST
LINE = 1.25 * SIZE * 25.4 / 72  # from one line of text to the next
HEAD = 1.25 * look.HEADING * 25.4 / 72  # ... in the heading of a block
NARROWEST = 25.0  # width that a heading needs
ROOM_FOR_LEGEND = 50.0
SWATCH = 4.5


@dataclass(frozen=True)
class Block:
    """One axis of the atlas: what is varied, and the outcome of every method in its cases.

    outcome: shape (methods, cases). The rest are measures in mm, and the heading's lines.
    """

    title: str
    note: str
    labels: list[str]
    outcome: np.ndarray
    width: float = 0.0
    label_height: float = 0.0

    @property
    def upright(self) -> bool:
        """Whether the labels of the cases stand upright, for want of width."""
        return self.label_height > LINE

    @property
    def heading_height(self) -> float:
        note = LINE * (self.note.count("\n") + 1) if self.note else 0.0
        return self.title_height + note + self.label_height + 2.0

    @property
    def title_height(self) -> float:
        return HEAD * (self.title.count("\n") + 1)


@dataclass(frozen=True)
class Band:
    """Blocks side by side, and the rows of methods that they share."""

    blocks: list[Block]

    @property
    def rows(self) -> np.ndarray:
        """The first method, and those that apply to a case of a block here."""
        used = np.any([(block.outcome != 0).any(axis=1) for block in self.blocks], axis=0)
        used[0] = True
        return np.flatnonzero(used)

    @property
    def heading_height(self) -> float:
        return max(block.heading_height for block in self.blocks)

    def height(self, row: float) -> float:
        """Height with rows of that height."""
        return self.heading_height + row * len(self.rows)

    @property
    def width(self) -> float:
        return sum(block.width for block in self.blocks) + GAP * (len(self.blocks) - 1)


@dataclass(frozen=True)
class Layout:
    """The bands, one above the other, and the legend.

    Attributes
    ----------
    left, column : float
        Where squares begin, and how wide they are, mm.
    bands : list of Band
    legend : list of str
        Texts, broken into lines.
    beside : bool
        Whether the legend stands right of the last band.
    fixed, free_row : float
        Height of all but the squares, and of a row that would fill the page, mm.
    """

    left: float
    column: float
    bands: list[Band]
    legend: list[str]
    beside: bool
    fixed: float
    free_row: float

    @property
    def row(self) -> float:
        """Height of a row that can be read and is not clumsy."""
        return min(max(self.free_row, ROW[0]), ROW[1])

    @property
    def height(self) -> float:
        """Height of the page."""
        short = legend_height(self.legend) - self.bands[-1].height(self.row)
        squares = self.row * sum(len(band.rows) for band in self.bands)
        return self.fixed + squares + (max(short, 0.0) if self.beside else 0.0)


def layout(methods: list[str], blocks: list[Block], legend: list[str]) -> Layout:
    """The layout with the widest squares that fits the page, or else the one that fits it best.

    legend: the texts of the legend. The blocks that come back have a letter in their titles.
    """
    measure = look.measurer(SIZE, "bold")
    left = MARGIN + max(measure(method) for method in methods) / MM + 1.5
    width = WIDTH - MARGIN - left
    widest = max(len(block.labels) for block in blocks)
    columns = [(width - GAP * (n - 1)) / (n * widest) for n in range(1, MOST_BESIDE + 1)]
    columns = [min(column, SQUARE[1]) for column in columns if column >= SQUARE[0]] or columns[:1]
    layouts = [_filled(blocks, left, column, legend) for column in dict.fromkeys(columns)]
    fitting = (found for found in layouts if found.free_row >= ROW[0])
    return next(fitting, max(layouts, key=lambda found: found.free_row))


def _filled(blocks: list[Block], left: float, column: float, texts: list[str]) -> Layout:
    """The layout for one width of the squares."""
    width = WIDTH - MARGIN - left
    letters = look.letters(len(blocks))
    pairs = zip(blocks, letters, strict=True)
    bands = _bands([_measured(block, column, letter) for block, letter in pairs], width)
    room = width - bands[-1].width - 2 * GAP
    beside = room > ROOM_FOR_LEGEND
    wide = (room if beside else WIDTH - 2 * MARGIN) - SWATCH - 2.0
    legend = [look.wrapped(text, wide * MM, SIZE) for text in texts]
    fixed = 2 * MARGIN + sum(band.heading_height for band in bands) + GAP * (len(bands) - 1)
    fixed += 0.0 if beside else GAP + legend_height(legend)
    row = (HEIGHT - fixed) / sum(len(band.rows) for band in bands)
    return Layout(left, column, bands, legend, beside, fixed, row)


def _measured(block: Block, column: float, letter: str) -> Block:
    """The block with its measures, its letter, and its heading broken into lines."""
    measure = look.measurer(SIZE)
    longest = max(measure(label) for label in block.labels) / MM
    width = max(column * len(block.labels), NARROWEST)
    return replace(
        block,
        title=look.wrapped(look.heading(letter, block.title), width * MM, look.HEADING),
        note=look.wrapped(block.note, width * MM, SIZE),
        label_height=LINE if longest < column - 0.8 else longest + 0.8,
        width=width,
    )


def _bands(blocks: list[Block], width: float) -> list[Band]:
    """The blocks in their order, in bands that fit the width and are least high together."""
    best: list[tuple[float, list[Band]]] = [(0.0, [])]
    for end in range(1, len(blocks) + 1):
        found: list[tuple[float, list[Band]]] = []
        for start in reversed(range(end)):
            band = Band(blocks[start:end])
            if found and band.width > width + 0.01:
                break
            height, above = best[start]
            found.append((height + band.height(ROW[0]) + GAP, [*above, band]))
        best.append(min(found, key=lambda option: option[0]))
    return best[-1][1]


def legend_height(legend: list[str]) -> float:
    """Height of the legend with these texts."""
    return sum(LINE * (text.count("\n") + 1) + 1.2 for text in legend)
