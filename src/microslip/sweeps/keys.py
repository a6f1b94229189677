"""Names of results and batches, which follow from what determines them.

A result is stored under a hash of everything that determines it: the physics, the tolerance, the
model and resolution asked for, and the sources of the solver. So it can be neither stale nor
computed twice. The versions of NumPy, SciPy and Numba are not part of a key: they change results
by rounding errors, far below any tolerance, and an upgrade should not discard days of computing.
Each result records them instead.

Imports nothing but the standard library, since the workflow reads it whenever it is parsed.
"""

from collections.abc import Iterable

from microslip.foundation.canonical import canonical_json, sha256

# Raise it when the content of a record changes without any change in the solver.
RECORD_FORMAT = 1


def result_key(request: dict, digest: str) -> str:
    """Name of the result that answers `request` when the code has this digest.

    request: dict of canonical strings, integers and None, see sweeps.batches; digest: of the
    modules that its answer depends on, see foundation.source_digest.
    """
    content = {"request": request, "source": digest, "format": RECORD_FORMAT}
    return sha256(canonical_json(content))


def batch_name(keys: Iterable[str]) -> str:
    """Name of a batch that holds the results with these keys, in this order."""
    return sha256("\n".join(keys))[:16]
