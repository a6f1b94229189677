"""Plan of a configuration: batches of requests, datasets, figures, and the inputs of each.

The workflow's rules use it; nothing here depends on Snakemake. Importing it is cheap, since the
workflow is parsed by every job.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cache, cached_property
from pathlib import PurePosixPath

from microslip.config.records import Configuration
from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json, fingerprint
from microslip.report.explorer import explorer
from microslip.report.figures import drawing
from microslip.studies import registry
from microslip.sweeps import batch_plans
from microslip.sweeps import batches as sweep

DATASET_CODE = ("datasets/sweep_dataset.py", "report/dataset_page.py")
"""Modules that make the dataset of a sweep, besides what these import."""
STUDY_CODE = ("datasets/sweep_dataset.py", "report/study_page.py", "studies")
CERTIFIED_CODE = ("datasets/certified_map.py", "report/dataset_page.py")
ROUND_CODE = ("sweeps/map_rounds.py",)
"""Modules that choose the next points of a certified map."""


class Plan:
    """The plan of a checked configuration. Paths are inside the folder of results.

    Attributes
    ----------
    configuration : Configuration
    studies : dict of str to str
        Studies by the names of their datasets.
    explored : list of str
        Names of the maps whose points have periods in the explorer.
    figures : dict of str to tuple of str
        Figures that there is data for, and the datasets of each.
    earlier : sweeps.batch_plans.Folder, or what does the same elsewhere; None
        What was planned before.  Batches stay as they are there, and new requests get new ones.
    """

    def __init__(self, configuration: Configuration, earlier: batch_plans.Folder | None = None):
        self.configuration, self.earlier = configuration, earlier
        self.studies = {dataset: study for study, dataset in registry.DATASETS.items()}
        self.explored = explorer.maps_of(configuration)
        self.figures = dict(_figures(configuration, self.studies))
        self._new_plans: dict[str, dict] = {}
        # each plan remembers its own answers
        self.batches_in = cache(self.batches_in)  # type: ignore[method-assign]
        self.points_of = cache(self.points_of)  # type: ignore[method-assign]
        self.fingerprint_of = cache(self.fingerprint_of)  # type: ignore[method-assign]

    # Batches

    @cached_property
    def early_groups(self) -> list[str]:
        """Groups of what takes long, so that it does not start when all else is done."""
        return [f"{study}_first" for study in self.studies.values()]

    @cached_property
    def groups(self) -> list[str]:
        """Names of all groups of batches: a sweep, or what is computed beside it."""
        sweeps = self.configuration.sweeps
        found = [group for name in sweeps for group in (name, f"{name}_histories")]
        found += [group for s in self.studies.values() for group in (f"{s}_first", s)]
        return [
            *found,
            *(f"{name}_periods" for name in self.explored),
            *self.configuration.extended,
            *self.configuration.drives,
        ]

    def batches_in(self, group: str) -> dict[str, Sequence[dict]]:
        """Requests of the batches of a group by name.

        Those of `extended` are made when they are asked for: names of motions with numbers are read
        by the solver, which jobs for other sweeps do without.
        """
        growing = self._growing(group)
        if growing is not None:
            return self._kept(group, *growing)
        name, _, beside = group.rpartition("_")
        if beside == "histories":
            requests = sweep.history_requests(self.configuration, name)
            return sweep.batches(requests, self.configuration.points_per_job[name])
        study = name if beside == "first" else group
        first, rest = registry.pieces(study, self.configuration)
        cuts = (sweep.batches(cut, len(cut)) for cut in (first if beside == "first" else rest))
        return {name: cut for batch in cuts for name, cut in batch.items()}

    def _growing(self, group: str) -> tuple[Sequence[dict], int] | None:
        """Requests of a group to which others may be added, and how many go into a batch; None for
        groups whose batches follow from what they are for."""
        configuration = self.configuration
        if group in configuration.grids:
            requests = sweep.PointRequests(configuration.grids[group])
            return requests, configuration.points_per_job[group]
        name, _, beside = group.rpartition("_")
        if beside == "periods":
            return explorer.period_requests(configuration, name), explorer.PERIODS_PER_JOB
        return None

    def _kept(self, group: str, requests: Sequence[dict], size: int) -> dict[str, Sequence[dict]]:
        """Batches that were planned before, and new ones for what is in none of them."""
        if self.earlier is None or not len(requests):
            return batch_plans.cut(requests, size, {})
        file = batch_plans.file_of(group, requests)
        planned = {
            name: cut
            for name, cut in batch_plans.batches_in(self.earlier.read(file)).items()
            if self.earlier.counts(f"batches/{group}/{name}.json")
        }
        found = batch_plans.cut(requests, size, planned)
        if not found.keys() <= planned.keys():
            self._new_plans[file] = planned | found
        return found

    def requests_of(self, group: str, batch: str) -> Sequence[dict] | None:
        """Requests of one batch, from what was planned before if it is there; None if it is not.

        A job asks this, and plans nothing that is not its own.
        """
        growing = None if self.earlier is None else self._growing(group)
        if self.earlier is not None and growing is not None and len(growing[0]):
            content = self.earlier.read(batch_plans.file_of(group, growing[0]))
            requests = batch_plans.requests_of(content, batch)
            if requests is not None:
                return requests
        return self.batches_in(group).get(batch)

    def keep_planned(self) -> None:
        """Note the new batches of all groups that were asked for, so that they stay as they are."""
        if self.earlier is None:
            return  # and nothing is new
        for file, planned in self._new_plans.items():
            self.earlier.write(file, batch_plans.text_of(planned))

    def plan_files(self) -> list[str]:
        """Files that say what was planned, of all groups."""
        growing = ((group, self._growing(group)) for group in self.groups)
        return [
            batch_plans.file_of(group, found[0]) for group, found in growing if found and found[0]
        ]

    def requests_in(self, group: str) -> list[dict]:
        """All requests of a group."""
        growing = self._growing(group)
        if growing:
            return list(growing[0])
        return [request for cut in self.batches_in(group).values() for request in cut]

    def points_of(self, group: str) -> str:
        """Fingerprint of the requests of a group, independent of the cut into batches."""
        growing = self._growing(group)
        requests = self.requests_in(group)
        if growing is None or not requests:
            return fingerprint(self.batch_files(group))
        return fingerprint(batch_plans.packed(requests), source_digest.of_request(requests[0]))

    def rounds_folder(self, name: str) -> str:
        """Folder of the rounds of a certified map and of what answers them.

        It is named by all that decides which points they have, so that they are never stale.
        """
        map_ = self.configuration.certified[name]
        code = source_digest.of_modules(*ROUND_CODE)
        solver = source_digest.of_request(sweep.PointRequests(map_.sweep)[0])
        return f"rounds/{name}/{fingerprint(map_.settings, code, solver)[:16]}"

    def groups_of(self, dataset: str) -> list[str]:
        """Groups whose batches a dataset is made of."""
        if dataset in self.studies:
            study = self.studies[dataset]
            return [f"{study}_first", study]
        return [dataset]

    def groups_beside(self, dataset: str) -> list[str]:
        """Groups whose batches hold the single runs in the dataset of a sweep."""
        group = f"{dataset}_histories"
        return [group] if group in self.groups else []

    # Files

    @property
    def datasets(self) -> list[str]:
        """Names of all datasets."""
        return [*self.configuration.grids, *self.studies]

    def batch_files(self, *groups: str) -> list[str]:
        """Files of all batches of these groups, those planned first before others."""
        return [
            f"batches/{group}/{name}.json" for group in groups for name in self.batches_in(group)
        ]

    def dataset_files(self, names: Iterable[str]) -> list[str]:
        """Files of datasets and of the pages about them."""
        return [file for name in names for file in (f"{name}.nc", f"summaries/{name}.html")]

    def figure_files(self, datasets: Iterable[str]) -> list[str]:
        """Files of all figures drawn from these datasets, perhaps with a map of the paper."""
        own = {
            figure: set(names) - set(self.configuration.sweeps) or set(names)
            for figure, names in self.figures.items()
        }
        return [
            f"figures/{figure}.{form}"
            for figure, names in own.items()
            if names <= set(datasets)
            for form in ("png", "pdf")
        ]

    def made_files(self) -> list[str]:
        """All files that are made to be kept: datasets, pages, figures."""
        names = [*self.datasets, *self.configuration.certified]
        return [*self.dataset_files(names), *self.figure_files(names), *explorer.PAGES]

    # What things are made of

    def code_of(self, file: str) -> str:
        """Digest of the code that makes a file, of those in `made_files`."""
        path = PurePosixPath(file)
        if file in explorer.PAGES:
            return explorer.digest()
        if path.parts[0] == "figures":
            return source_digest.of_modules(*drawing.modules_of(path.stem))
        if path.stem in self.configuration.certified:
            return source_digest.of_modules(*CERTIFIED_CODE)
        return source_digest.of_modules(
            *(STUDY_CODE if path.stem in self.studies else DATASET_CODE)
        )

    def refuse_edited(self, file: str, code: str) -> None:
        """Raise SourcesEdited if the code that makes a file is not, or no longer, the planned one.

        code: what `code_of` said when the file was planned.
        """
        if code != self.code_of(file):
            raise sweep.SourcesEdited("the code that makes it")

    def settings_of(self, dataset: str) -> str:
        """All settings that a dataset depends on, as JSON."""
        if dataset in self.studies:
            return canonical_json(registry.settings(self.studies[dataset], self.configuration))
        return canonical_json(self.configuration.of_sweep(dataset))

    def fingerprint_of(self, file: str) -> str:
        """Fingerprint of the settings, code and points of a file in `made_files`."""
        path, code = PurePosixPath(file), self.code_of(file)
        names: Sequence[str]
        groups: Sequence[str]
        if file in explorer.PAGES:
            names = explorer.datasets_of(self.configuration, file)
            groups = [f"{name}_periods" for name in self.explored]
        elif path.parts[0] == "figures":
            names, groups = self.figures[path.stem], ()
        elif path.stem in self.configuration.certified:
            return fingerprint(code, self.rounds_folder(path.stem))
        else:
            groups = [*self.groups_of(path.stem), *self.groups_beside(path.stem)]
            return fingerprint(code, self.settings_of(path.stem), [*map(self.points_of, groups)])
        datasets = [self.fingerprint_of(f"{name}.nc") for name in names]
        return fingerprint(code, path.stem, datasets, [*map(self.points_of, groups)])


def _figures(
    configuration: Configuration, of_studies: dict[str, str]
) -> Iterator[tuple[str, tuple[str, ...]]]:
    """(name, names of its datasets) of the figures that there is data for."""
    for figure, names in drawing.FIGURES.items():
        sources = (configuration.sweeps, configuration.drives, of_studies)
        known = all(any(name in source for source in sources) for name in names)
        if known and _is_drawable(figure, names, configuration):
            yield figure, names
    for group, names in configuration.groups.items():
        yield drawing.figure_of(group), names
    yield from ((name, (name,)) for name in configuration.certified)


def _is_drawable(figure: str, names: tuple[str, ...], configuration: Configuration) -> bool:
    """Whether there is enough of a map for the figures that show maps, and whether what is compared
    is of the same amplitude and velocity."""
    if figure == "drives":
        moved, *pulled, body = (configuration.grids[name] for name in names)
        same = {grid.amplitude for grid in (*pulled, body)} == {body.amplitude}
        return (
            same and _has(moved.amplitude, body.amplitude) and _has(moved.velocity, body.velocity)
        )
    if figure == "pairs":
        return len({configuration.grids[name].amplitude for name in names}) == 1
    if figure not in ("fig2_transverse_map", "fig6_bore_map", "poisson"):
        return True
    grids = [configuration.sweeps[name] for name in names]
    if not all(grid.spans_a_map for grid in grids):
        return False
    few = all(1 < len(grid.poisson) <= drawing.MOST_POISSONS for grid in grids)
    return few or figure != "poisson"


def _has(axis: Sequence[float] | None, wanted: Sequence[float] | None) -> bool:
    """Whether one value is wanted, and an axis has it but for rounding."""
    if axis is None or wanted is None:
        return False
    return len(wanted) == 1 and any(math.isclose(value, wanted[0]) for value in axis)
