"""Registry of the studies: cost of accuracy, failures of methods, and check of the paper.

A study is a module with three functions and two strings:

- requests(settings): yields pairs of a job and a request;
- values(settings, answers): returns the values of the dataset's variables, computed from answers;
- report(dataset): yields lines of text that summarise the dataset;
- TITLE and COMMENT: attributes of the dataset.

A job is a tuple.  Jobs with a smaller first number start earlier.

The variables of all datasets are listed in variables.csv, and the groups in groups.csv.  The column
`source` names an entry of a row.  The values of the variable are taken from this entry (see
answers.columns).  If `source` is empty, the entry has the name of the variable.

The workflow imports these modules at every start, so they do not import the solver or xarray at
module level.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from importlib import import_module
from types import ModuleType
from typing import TYPE_CHECKING

from microslip.foundation.canonical import canonical_json, sha256
from microslip.studies.answers import Answers, rows_of
from microslip.sweeps.batch import lookup

if TYPE_CHECKING:
    import xarray as xr

    from microslip.config.settings import Configuration, Settings


def pieces(study: str, settings: Settings) -> list[list[dict]]:
    """Return the jobs of a study, slow jobs first.  A job is a list of distinct requests."""
    jobs: dict[tuple, list[dict]] = {}
    requested = set()
    for job, request in _module(study).requests(settings):
        text = canonical_json(request)
        if text not in requested:
            requested.add(text)
            jobs.setdefault(job, []).append(request)
    return [jobs[job] for job in sorted(jobs, key=lambda job: job[0])]


def build(
    configuration: Configuration, study: str, records: Iterable[dict]
) -> tuple[xr.Dataset, dict[str, xr.Dataset]]:
    """Build the dataset of a study, and a dict of the datasets of its groups.

    The settings are stored as an attribute in JSON.

    records: records of all requests of the study, in any order.
    """
    import xarray as xr

    from microslip.datasets import netcdf, sweep_dataset
    from microslip.datasets.variables import described

    module, settings = _module(study), configuration.studies[study]
    answers = Answers(lookup(records))
    values = module.values(settings, answers)
    table = {row["name"]: row for row in rows_of("variables.csv", study)}
    variables = {name: described(table[name], values[name]) for name in table if name in values}
    # The keys also depend on the source code of the methods.
    keys = sorted({row["key"] for _, row in answers.rows.values()})
    more = {"results_digest": sha256("\n".join(keys)), "comment": module.COMMENT}
    own = settings.model_dump()
    more |= {"tolerance": own["tolerance"]} if "tolerance" in own else {}
    attributes = sweep_dataset.provenance(module.TITLE, own, answers.versions, **more)
    dataset = xr.Dataset(variables, attrs=attributes)
    return netcdf.divide(dataset, rows_of("groups.csv", study))


def report(dataset: xr.Dataset, study: str) -> Iterator[str]:
    """Yield lines of text that summarise the dataset of a study."""
    yield from _module(study).report(dataset)


def _module(study: str) -> ModuleType:
    return import_module(f"microslip.studies.{study}")
