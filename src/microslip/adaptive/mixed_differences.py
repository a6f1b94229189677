"""What two axes of refinement do together, which chains along each of them cannot see."""

from __future__ import annotations

from collections.abc import Callable

from microslip.adaptive.chains import Chain, Runs, refines_cells


def mixed_differences(
    runs: Runs, chains: dict[str, Chain], read: Callable, other: str
) -> tuple[float, ...]:
    """How far the corrections along the cells and another axis fail to add up.

    These are their mixed differences: with the angles one, next to the finest of them, since few
    may hide what cells are worth, and, of cells whose error is irregular, twice as fine; with the
    steps two, at the first finer ones of their chain and both counts of cells, since one alone may
    be small by chance where the cells scatter.

    Parameters
    ----------
    runs : chains.Runs
        Those of all chains; what is lacking is done.
    chains : dict of chains.Chain
        By the names of their axes.
    read : callable
        read(run) returns the quantity, a number or a vector.
    other : str
        "angles" or "steps".

    Returns
    -------
    tuple of float
        In the unit of the quantity (dimensionless); a single 0 where none is to be measured.
    """
    first = refines_cells(chains)
    unmeasured = first is None or other not in chains or chains[first].axis.imposed
    if unmeasured or not chains[other].axis.mixed:
        return (0.0,)

    def at(axis, step):
        """A run beside the base: on the chain, or coarser where that ends at the base."""
        base, last = runs.base[axis], chains[axis].indices[-1]
        return {axis: min(base + step, last) if last > base else base - 1}

    base, indices = runs.base[other], chains[other].indices
    if other == "angles":
        along = at(other, max(indices[-1] - base - 1, 1))
        finer = (1,) if chains[first].axis.regular else (2,)
    else:
        along = at(other, next((index - base for index in indices if index > base), 1))
        finer = (1, 2)

    def value(**indices):
        return read(runs(**indices))

    return tuple(
        value(**at(first, step), **along) - value(**at(first, step)) - value(**along) + value()
        for step in finer
    )
