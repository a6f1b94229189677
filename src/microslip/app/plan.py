"""Plan of a configuration: batches of requests, products, and what each product is made of.

The workflow's rules use it; nothing here depends on Snakemake.  Importing it is cheap, since the
workflow is parsed by every process that Snakemake starts.

A product is a dataset with its page ("bore"), a figure ("figures/fig6_bore_map") or a page of the
explorer ("pages/explorer").  A group of batches is named like the sweep, the study or the certified
map that it answers, or "bore_histories" for the single runs in a dataset, "bore_periods" for the
explorer, and "claims_first" for the slow part of a study.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from functools import cache, cached_property

from microslip.config.records import Configuration
from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json, fingerprint
from microslip.report.explorer import explorer
from microslip.report.figures import drawing
from microslip.studies import registry
from microslip.sweeps import batches
from microslip.sweeps.batches import Batch, SourcesEdited

DATASET_CODE = ("datasets/sweep_dataset.py", "report/dataset_page.py")
"""Modules that make the dataset of a sweep and its page, besides those that they import."""
STUDY_CODE = ("datasets/sweep_dataset.py", "report/study_page.py", "studies")
CERTIFIED_CODE = ("datasets/certified_map.py", "report/dataset_page.py")
REFINEMENT_CODE = ("sweeps/map_refinement.py",)
"""Modules that choose the points of a certified map."""
TARGETS = {
    "all": "the datasets and figures of the configuration's sweeps (unless said otherwise)",
    "extended": "the same of other motions and pressures, its key extended",
    "drives": "datasets of contacts that a force or a spring pulls, its key drives",
    "certified": "maps with an error that holds everywhere, of the sweeps that say adaptive",
    "accuracy": "what accuracy costs, for all models and methods",
    "stability": "where methods fail",
    "claims": "what the paper says, judged",
    "propulsion": "what self-propelled motions pull with, from stall to no load",
    "explorer": "one page that shows what is behind every point of the maps",
    "explorer_all": "the same page with every other sweep of the configuration",
}
"""Targets of the workflow that users need, and what each makes."""


class Plan:
    """The plan of a checked configuration.  Paths are inside the folder of results.

    Attributes
    ----------
    configuration : Configuration
    studies : dict of str to str
        Studies by the names of their datasets.
    figures : dict of str to tuple of str
        Figures that there is data for, and the datasets of each.
    explored : list of str
        Names of the maps whose points have periods in the explorer.
    """

    def __init__(self, configuration: Configuration):
        self.configuration = configuration
        self.studies = {dataset: study for study, dataset in registry.DATASETS.items()}
        self.figures = dict(_figures(configuration, self.studies))
        self.explored = explorer.maps_of(configuration)
        self.batches_in = cache(self._batches_in)
        self.made_of = cache(self._made_of)

    # Batches

    @cached_property
    def groups(self) -> list[str]:
        """Names of all groups of batches except certified maps."""
        studies = self.studies.values()
        return [
            *self.configuration.grids,
            *(f"{name}_histories" for name in self.configuration.sweeps),
            *(f"{name}_periods" for name in self.explored),
            *(group for study in studies for group in (f"{study}_first", study)),
        ]

    def _batches_in(self, group: str) -> dict[str, Batch]:
        """Batches of a group by name, in the order of its requests; none for a certified map."""
        configuration = self.configuration
        name, _, beside = group.rpartition("_")
        if group in configuration.grids:
            points = batches.PointRequests(configuration.grids[group])
            found = batches.batches_of_points(points, configuration.points_per_job[group])
        elif beside == "histories":
            found = [
                Batch(runs) for runs in [batches.history_requests(configuration, name)] if runs
            ]
        elif beside == "periods":
            periods = explorer.period_requests(configuration, name)
            found = batches.batches_of_requests(periods, explorer.PERIODS_PER_JOB)
        elif group in configuration.certified:
            found = []
        else:
            study = name if beside == "first" else group
            slow, fast = registry.pieces(study, configuration)
            found = [Batch(piece) for piece in (slow if beside == "first" else fast)]
        return {batch.name: batch for batch in found}

    def map_batch(self, name: str) -> str:
        """Name of the batch that holds all points of a certified map."""
        map_ = self.configuration.certified[name]
        solver = source_digest.of_request(batches.PointRequests(map_.sweep)[0])
        code = source_digest.of_modules(*REFINEMENT_CODE)
        return fingerprint(map_.settings, code, solver)[:20]

    def batch_files(self, *groups: str) -> list[str]:
        """Files of all batches of these groups, in their order."""
        certified = self.configuration.certified
        return [
            f"batches/{group}/{name}.jsonl"
            for group in groups
            for name in ([self.map_batch(group)] if group in certified else self.batches_in(group))
        ]

    def groups_of(self, product: str) -> list[str]:
        """Groups whose batches a product is made of; single runs in a dataset come after points."""
        if product.startswith("figures/"):
            return []
        if product.startswith("pages/"):
            return [f"{name}_periods" for name in self.explored]
        if product in self.studies:
            return [f"{self.studies[product]}_first", self.studies[product]]
        histories = [f"{product}_histories"] * (product in self.configuration.sweeps)
        return [product, *histories]

    # Products

    @property
    def datasets(self) -> list[str]:
        """Names of all datasets."""
        return [*self.configuration.grids, *self.configuration.certified, *self.studies]

    def datasets_of(self, product: str) -> Sequence[str]:
        """Names of the datasets that a figure or a page is made of."""
        kind, _, name = product.rpartition("/")
        if kind == "figures":
            return self.figures[name]
        return explorer.datasets_of(self.configuration, f"{name}.html") if kind else ()

    def files(self, product: str) -> list[str]:
        """Files of a product."""
        kind, _, name = product.rpartition("/")
        if kind == "figures":
            return [f"figures/{name}.png", f"figures/{name}.pdf"]
        return [f"{name}.html"] if kind else [f"{name}.nc", f"summaries/{name}.html"]

    @property
    def products(self) -> list[str]:
        """All products."""
        pages = [f"pages/{page.removesuffix('.html')}" for page in explorer.PAGES]
        return [*self.datasets, *(f"figures/{name}" for name in self.figures), *pages]

    def with_figures(self, datasets: Iterable[str]) -> list[str]:
        """Datasets, and the figures drawn from them alone, or from them and maps of the paper."""
        datasets, paper = [*datasets], set(self.configuration.sweeps)
        drawn = [
            f"figures/{figure}"
            for figure, names in self.figures.items()
            if (set(names) - paper or set(names)) <= set(datasets)
        ]
        return [*datasets, *drawn]

    def products_of(self, target: str) -> list[str]:
        """Products that a key of TARGETS asks for."""
        configuration = self.configuration
        drift = [name for name, map_ in configuration.certified.items() if map_.force is not None]
        datasets = {
            "all": [*configuration.sweeps],
            "extended": [*configuration.extended],
            "drives": [*configuration.drives, *drift],
            "certified": [name for name in configuration.certified if name not in drift],
        } | {study: [dataset] for dataset, study in self.studies.items()}
        if target in datasets:
            return self.with_figures(datasets[target])
        return [f"pages/{target}"]

    # What products are made of

    def code_of(self, product: str) -> str:
        """Digest of the code that makes a product from its batches or datasets."""
        kind, _, name = product.rpartition("/")
        if kind == "pages":
            return explorer.digest()
        if kind == "figures":
            return source_digest.of_modules(*drawing.modules_of(name))
        if product in self.configuration.certified:
            return source_digest.of_modules(*CERTIFIED_CODE)
        return source_digest.of_modules(*(STUDY_CODE if name in self.studies else DATASET_CODE))

    def _made_of(self, product: str) -> str:
        """Fingerprint of the code, settings and points of a product.

        It does not depend on how the points of a sweep are cut into batches.
        """
        settings = ""
        if product in self.studies:
            settings = canonical_json(registry.settings(self.studies[product], self.configuration))
        elif product in self.configuration.grids:
            settings = canonical_json(self.configuration.of_sweep(product))
        datasets = [self.made_of(name) for name in self.datasets_of(product)]
        points = [self._points_in(group) for group in self.groups_of(product)]
        return fingerprint(product, self.code_of(product), settings, datasets, points)

    def _points_in(self, group: str) -> object:
        if group not in self.configuration.grids:
            return self.batch_files(group)
        requests = batches.PointRequests(self.configuration.grids[group])
        return [requests.rows, requests.last, source_digest.of_request(requests[0])]

    def refuse_edited(self, product: str, made_of: str) -> None:
        """Raise SourcesEdited if a product was to be made by other code when it was planned.

        made_of: what `made_of` gave then.
        """
        if made_of != self.made_of(product):
            raise SourcesEdited("the code that makes it")


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


def figure_targets(plan: Plan) -> dict[str, str]:
    """Figures by the names of their targets: their own names, and fig1 to fig6.

    Figures that the configuration has no data for are among them, see `why_no_figure`.
    """
    names = {name: name for name in (*drawing.FIGURES, *plan.figures)} | drawing.SHORT_NAMES
    return {name: figure for name, figure in names.items() if name not in TARGETS}


def why_no_figure(plan: Plan, figure: str) -> str:
    """Why a configuration leads to no such figure, a key of drawing.FIGURES, in one line."""
    configuration, names = plan.configuration, drawing.FIGURES[figure]
    known = {*configuration.sweeps, *configuration.drives, *plan.studies}
    missing = [name for name in names if name not in known]
    if missing:
        return f"{figure} needs the sweep {missing[0]}, which the configuration has not"
    return (
        f"{figure} cannot be drawn from {' and '.join(names)}: a map needs several velocities and "
        "amplitudes, and some figures need equal or several values of other axes"
    )
