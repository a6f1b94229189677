"""What the solver says where a map is not good enough, kept beside the map if that is possible."""

from __future__ import annotations

import warnings
from functools import cache
from tempfile import TemporaryDirectory

from microslip.adaptive.result import Result
from microslip.sweeps.sealed_files import CacheError
from microslip.sweeps.solve_stored import solve_stored


def solved(folder: str, *point, **settings) -> Result:
    """What solve_stored says, kept in the folder, or for now where that takes nothing."""
    try:
        return solve_stored(*point, results=folder, **settings)
    except CacheError as error:
        warnings.warn(f"answers are not kept: {error}", stacklevel=4)
        return solve_stored(*point, results=_spare_folder().name, **settings)


@cache
def _spare_folder():
    """A folder that is gone when Python ends."""
    return TemporaryDirectory(prefix="microslip-")
