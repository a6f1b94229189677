"""Plan of a configuration: its batches of requests, its products, and the inputs of each product.

The module does not import Snakemake.  It must be fast to import, since every Snakemake process
parses the workflow.

A product is a dataset with its page ("bore"), a figure ("figures/fig6_bore_map") or a page of the
explorer ("pages/explorer").  A group of batches is named after its sweep, study or certified map.
The group "bore_histories" contains the single runs for a dataset, and "bore_periods" contains the
single runs for the explorer.
"""

from __future__ import annotations

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from functools import cache, cached_property
from typing import Any, NamedTuple

from microslip.app import figure_targets
from microslip.app.job_log import job_log
from microslip.config import load
from microslip.config.records import ConfigError, Configuration
from microslip.foundation import source_digest
from microslip.foundation.canonical import fingerprint
from microslip.report.explorer import explorer
from microslip.report.figures import drawing
from microslip.studies import registry
from microslip.sweeps import batches, stamps
from microslip.sweeps.batches import Batch, SourcesEdited

DATASET_CODE = ("datasets/sweep_dataset.py", "report/dataset_page.py")
"""Modules that make a sweep's dataset and page.  Modules that they import are not listed."""
STUDY_CODE = ("datasets/sweep_dataset.py", "report/claims_page.py", "report/claims.html", "studies")
CERTIFIED_CODE = ("datasets/certified_map.py", "report/dataset_page.py")
PAGE_CODE = ("report/explorer", "sweeps/period_codec.py")
REFINEMENT_CODE = ("sweeps/map_refinement.py",)
"""Modules that choose the points of a certified map."""


class Product(NamedTuple):
    """Files that a job makes from batches or datasets.

    Attributes
    ----------
    files : list of str
        Paths relative to the folder of results.
    code : tuple of str
        Modules that make the product.  Modules that they import are not listed.
    datasets, groups : sequence of str
        Names of the input datasets and of the input batch groups.
    settings : dict
        Settings that influence the product, as JSON values.
    """

    files: list[str]
    code: tuple[str, ...]
    datasets: Sequence[str] = ()
    groups: Sequence[str] = ()
    settings: dict | None = None


class Plan:
    """The plan of a checked configuration.  Paths are relative to the folder of results.

    Attributes
    ----------
    configuration : Configuration
    studies : dict of str to str
        Name of the study that makes each dataset, by dataset name.
    figures : dict of str to tuple of str
        Figures for which the configuration has data, each with the names of its datasets.
    products : dict of str to Product
        All products, by name.
    """

    def __init__(self, configuration: Configuration):
        self.configuration = configuration
        self.studies = {dataset: study for study, dataset in registry.DATASETS.items()}
        self.figures = figure_targets.drawable(configuration)
        self.products = dict(self._products())
        self.batches_in = cache(self._batches_in)  # not @cache, since it would keep every plan
        self.made_of = cache(self._made_of)

    # Batches

    @cached_property
    def groups(self) -> list[str]:
        """Names of all groups of batches except certified maps."""
        return [
            *self.configuration.grids,
            *(f"{name}_histories" for name in self.configuration.sweeps),
            *(f"{name}_periods" for name in explorer.maps_of(self.configuration)),
            *self.studies.values(),
        ]

    def _batches_in(self, group: str) -> dict[str, Batch | None]:
        """Batches of a group by name, in the order of the requests.

        A certified map has one batch with all points.  Its value is None, because its requests
        depend on the results.
        """
        configuration = self.configuration
        name, _, runs = group.rpartition("_")
        if group in configuration.grids:
            points = batches.points_of(configuration.grids[group])
            blocks = batches.divide(points, configuration.points_per_job[group])
        elif runs == "histories":
            histories = batches.history_requests(configuration, name)
            blocks = [Batch(histories)] if histories else []
        elif runs == "periods":
            periods = explorer.period_requests(configuration, name)
            blocks = [Batch(part) for part in batches.cut(periods, explorer.PERIODS_PER_JOB)]
        elif group in configuration.certified:
            map_ = configuration.certified[group]
            solver = source_digest.of_request(batches.points_of(map_.sweep).rows[0])
            code = source_digest.of_modules(*REFINEMENT_CODE)
            return {fingerprint(map_.settings, code, solver)[:20]: None}
        else:
            slow, fast = registry.pieces(group, configuration)
            blocks = [Batch(piece) for piece in (*slow, *fast)]
        return {batch.name: batch for batch in blocks}

    def batch_files(self, *groups: str) -> list[str]:
        """Return the paths of all batches in these groups, in the order of the groups."""
        return [
            f"batches/{group}/{name}.jsonl" for group in groups for name in self.batches_in(group)
        ]

    # Products

    def _products(self) -> Iterator[tuple[str, Product]]:
        configuration = self.configuration
        for name in self.datasets:
            files, groups = [f"{name}.nc", f"summaries/{name}.html"], [name]
            if name in configuration.certified:
                yield name, Product(files, CERTIFIED_CODE, (), groups)
            elif name in self.studies:
                settings = registry.settings(self.studies[name], configuration)
                yield name, Product(files, STUDY_CODE, (), [self.studies[name]], settings)
            else:  # single runs come after points
                groups += [f"{name}_histories"] * (name in configuration.sweeps)
                yield name, Product(files, DATASET_CODE, (), groups, configuration.of_sweep(name))
        for name, datasets in self.figures.items():
            files = [f"figures/{name}.{form}" for form in ("png", "pdf")]
            yield f"figures/{name}", Product(files, drawing.modules_of(name), datasets)
        periods = [f"{name}_periods" for name in explorer.maps_of(configuration)]
        for page in explorer.PAGES:
            datasets = tuple(explorer.datasets_of(configuration, page))
            name = page.removesuffix(".html")
            yield f"pages/{name}", Product([page], PAGE_CODE, datasets, periods)

    @property
    def datasets(self) -> list[str]:
        """Names of all datasets."""
        return [*self.configuration.grids, *self.configuration.certified, *self.studies]

    @property
    def targets(self) -> list[str]:
        """Names of all targets: the keys of TARGETS, all figures, and fig1 to fig6."""
        names = (*figure_targets.TARGETS, *drawing.FIGURES, *self.figures, *drawing.SHORT_NAMES)
        return list(dict.fromkeys(names))

    def products_of(self, target: str) -> list[str]:
        """Return the products of a target.  Raises ConfigError if the configuration has no data for
        it."""
        configuration = self.configuration
        datasets = {
            "all": [*configuration.sweeps],
            "extended": [*configuration.extended],
            "drives": [*configuration.drives],
            "certified": [*configuration.certified],
        } | {study: [dataset] for dataset, study in self.studies.items()}
        if target in datasets:
            inputs, paper = set(datasets[target]), set(configuration.sweeps)
            figures = [
                f"figures/{figure}"
                for figure, names in self.figures.items()
                if (set(names) - paper or set(names)) <= inputs  # maps of the paper may be added
            ]
            return [*datasets[target], *figures]
        page = f"{target}.html"
        if page in explorer.PAGES:
            if problem := explorer.refusal(configuration, page):
                raise ConfigError(problem)
            return [f"pages/{target}"]
        figure = drawing.SHORT_NAMES.get(target, target)
        if figure not in self.figures:
            raise ConfigError(figure_targets.why_no_figure(configuration, figure))
        return [f"figures/{figure}"]

    # Fingerprints of the inputs of products

    def _made_of(self, product: str) -> str:
        """Fingerprint of a product's code, settings and points.  It does not depend on how points
        are divided into batches."""
        _, modules, datasets, groups, settings = self.products[product]
        inputs = [self.made_of(dataset) for dataset in datasets]
        grids = self.configuration.grids
        points = [
            batches.points_of(grids[group]).name if group in grids else self.batch_files(group)
            for group in groups
        ]
        return fingerprint(product, source_digest.of_modules(*modules), settings, inputs, points)


@contextmanager
def product_job(
    job: Any, product: str, shown: int = logging.WARNING
) -> Iterator[tuple[Plan, logging.Logger]]:
    """Context manager for a job that makes a product.  It yields the plan and a logger.

    It first renames damaged files of the product, and finally writes the stamp.  Raises
    SourcesEdited if the product's fingerprint has changed since the job was planned.

    job: the script's variable `snakemake`; its last output is the stamp.  shown: lowest level of
    messages on standard error.
    """
    outputs, made_of = job.output[:-1], job.params.made_of
    with job_log(job.log[0], shown) as log:
        plan = Plan(load.from_mapping(job.config, ask_solver=False))
        if made_of != plan.made_of(product):
            raise SourcesEdited("the code that makes it")
        stamps.set_aside(job.output.stamp, outputs)
        yield plan, log
        stamps.write(job.output.stamp, made_of, outputs)
