"""Plan of a configuration: the products, the batches of requests for the products, and the files
that are missing in the folder of results.

A product is one of the following: a dataset with its page; a figure; a page of the explorer.  The
files of a product are named by content, such as data/bore.0123456789abcdef.nc.  The name contains a
hash of everything that the product is made from, so that an existing file is always up to date.
Plain names, such as bore.nc, are links.

This module does not import Snakemake.  The import of this module must be fast, since every
Snakemake process parses the workflow.
"""

from __future__ import annotations

import os
from functools import cache, cached_property
from itertools import count
from pathlib import Path
from typing import NamedTuple

from microslip.config.settings import Configuration
from microslip.foundation import source_digest
from microslip.foundation.canonical import canonical_json, fingerprint
from microslip.report.explorer import explorer
from microslip.report.figures import drawing
from microslip.studies import registry
from microslip.sweeps import content, request
from microslip.sweeps.batch import Job, SourcesEdited
from microslip.sweeps.request import Batch

BUILDERS = {
    "sweep": ("datasets/sweep_dataset.py", "report/pages.py"),
    "certified": ("datasets/certified_map.py", "report/pages.py"),
    **dict.fromkeys(("accuracy", "stability"), ("studies", "report/pages.py")),
    "claims": ("studies", "report/pages.py", "report/claims.html"),
    "explorer": ("report/explorer", "sweeps/period_codec.py"),
}
"""Modules and folders that make each kind of product.  The modules that these modules import are
added."""
MAP_CODE = ("sweeps/map_refinement.py", "sweeps/map_coordinates.py")
"""Modules that choose the points of a certified map."""

MOST_COUNTED = 50_000
"""Largest number of points for which stored results are searched in order to count the new points.
The records of more points would fill the memory."""


class Product(NamedTuple):
    """Files that a job makes from batches or datasets.

    Attributes
    ----------
    kind : str
        Key of BUILDERS, or a kind of figure.
    rule : str
        Rule that makes the product: "dataset", "figure" or "explorer".
    stem : str
        Name of the files, without extension. It consists of the name of the product and the hash of
        its content.
    links : dict of str to str
        Extension of each file, keyed by the plain name of the link to it.
    inputs : tuple of str
        Names of the datasets that the product is made from.
    """

    kind: str
    rule: str
    stem: str
    links: dict[str, str]
    inputs: tuple[str, ...] = ()


class Plan:
    """The plan of a checked configuration.

    Attributes
    ----------
    configuration : Configuration
    products : dict of str to Product
        All products, keyed by name, datasets first.
    """

    def __init__(self, configuration: Configuration):
        self.configuration = configuration
        self._maker = source_digest.LOADED.digest(["app/products.py"])
        self._maker += source_digest.of_script("workflow/scripts/make.py")
        self.products: dict[str, Product] = {}
        for name in (*configuration.datasets, *configuration.figures):
            self.products[name] = self._product(name)
        self.batches = cache(self._batches)  # not @cache, since it would keep every plan

    def _product(self, name: str) -> Product:
        """Return a product.  The name of the product's files contains a hash of everything that the
        files are made from."""
        configuration = self.configuration
        sweep, figure = configuration.sweeps.get(name), configuration.figures.get(name)
        kind, rule = name, "dataset"
        inputs: tuple[str, ...] = ()
        parts: tuple
        links = {f"{name}.nc": ".nc", f"summaries/{name}.html": ".html"}
        if figure is not None:
            kind, rule, inputs = figure.kind, "figure", figure.datasets
            links = {f"figures/{name}{ending}": ending for ending in (".png", ".pdf")}
            if kind == "explorer":
                rule, links = "explorer", {f"{name}.html": ".html"}
        if sweep is not None:
            kind = "certified" if sweep.is_certified else "sweep"
            common, runs = request.settings_of(sweep), request.runs_of(configuration, name)
            solver = source_digest.of_request(common)
            code = source_digest.of_builder(*MAP_CODE) if sweep.is_certified else ""
            parts = common, sweep.model_dump(mode="json"), runs, solver, code
        else:
            study = configuration.studies.get(name)
            settings = None if study is None else study.model_dump(mode="json")
            stems = [self.products[dataset].stem for dataset in inputs]
            parts = stems, list(self._batches(name)), settings
        files = BUILDERS.get(kind) or drawing.modules_of(kind)
        digest = source_digest.of_builder(*files), self._maker
        stem = f"{name}.{fingerprint(kind, digest, *parts)[: request.CONTENT_NAME]}"
        return Product(kind, rule, stem, links, inputs)

    def _batches(self, name: str) -> dict[str, Batch | None]:
        """Return the batches of a product in the order of the requests.  The keys are the paths,
        without extension, of the batch files.

        A certified map has one batch with all points.  The value of this batch in the dict is None,
        because the requests of the batch depend on results.
        """
        configuration, blocks = self.configuration, []
        if (sweep := configuration.sweeps.get(name)) is not None:
            if sweep.is_certified:
                folder = request.folder_of(request.solver_names(sweep)[0])
                return {f"{folder}/{self.products[name].stem.partition('.')[2]}": None}
            blocks = request.divide(request.points_of(sweep), configuration.points_per_job)
            runs = request.runs_of(configuration, name)
            blocks += [Batch(runs)] if runs else []
        elif name in configuration.studies:
            blocks = list(map(Batch, registry.pieces(name, configuration.studies[name])))
        elif configuration.figures[name].kind == "explorer":
            maps = explorer.maps_of(configuration, configuration.figures[name])
            for one in maps:
                periods = explorer.period_requests(configuration, *maps, name=one)
                blocks += map(Batch, request.cut(periods, explorer.PERIODS_PER_JOB))
        return {f"{block.folder}/{block.name}": block for block in blocks}


class Results:
    """The folder with the results of a plan.

    A damaged file, or a file with failed points, is not replaced.  Instead, the new file has a
    number in its name, such as data/bore.0123456789abcdef-1.nc.

    Attributes
    ----------
    stems : dict of str to str
        Name, without extension, of the files of each product, keyed by the name of the product.
    missing : dict of str to list of str
        Paths of the inputs of each product that the folder lacks, keyed by the name of the product.
        Datasets come first, then batches.
    """

    def __init__(self, plan: Plan, folder: str | Path, here: bool = True, whole: bool = False):
        """Find the complete files of all products, and the missing inputs of incomplete products.

        here: False for a folder in remote storage, which counts as empty.  whole: if True, list the
        inputs of all products."""
        self.plan, self.folder, self.here = plan, Path(folder), here
        self._listed = cache(self._list)
        self.stems: dict[str, str] = {}
        self.missing: dict[str, list[str]] = {}
        complete: set[str] = set()
        for name, product in plan.products.items():
            endings = tuple(product.links.values())
            self.stems[name], is_there = self._chosen("data", product.stem, endings)
            if is_there and complete.issuperset(product.inputs):
                complete.add(name)
            if whole or name not in complete:
                datasets = [f"data/{self.stems[dataset]}.nc" for dataset in product.inputs]
                self.missing[name] = datasets + self.batch_files(name)

    def files(self, name: str) -> list[str]:
        """Return the paths of the files of a product."""
        return [f"data/{self.stems[name]}{end}" for end in self.plan.products[name].links.values()]

    def batch_files(self, name: str) -> list[str]:
        """Return the paths of the batch files of a product."""
        paths = []
        for path in self.plan.batches(name):
            folder, _, stem = f"batches/{path}".rpartition("/")
            paths.append(f"{folder}/{self._chosen(folder, stem, ('.jsonl',))[0]}.jsonl")
        return paths

    def link(self) -> None:
        """Link the plain names of products to their files, if the files exist.

        If the file does not exist, the date of the link is set far back.  The reason is that
        Snakemake replaces a link only if an input is newer.
        """
        for plain, (_, path) in self.plain().items():
            link = self.folder / plain
            if (self.folder / path).exists():
                content.link(self.folder / path, link)
            elif link.exists():
                os.utime(link, (1, 1), follow_symlinks=False)
            elif link.is_symlink():
                link.unlink()  # Snakemake fails for a link without its file

    def stems_of(self, rule: str) -> list[str]:
        """Return the names, without extension, of the missing files that a rule makes."""
        return [self.stems[n] for n in self.missing if self.plan.products[n].rule == rule]

    @cached_property
    def _needed(self) -> dict[Path, Batch | None]:
        """Return the missing batches that missing products need.  Each key is the path of a batch
        file."""
        needed: dict[Path, Batch | None] = {}
        for name in self.missing:
            paths = (self.folder / path for path in self.batch_files(name))
            needed |= zip(paths, self.plan.batches(name).values(), strict=True)
        return {path: batch for path, batch in needed.items() if not path.exists()}

    def batches(self, certified: bool) -> list[str]:
        """Return the names, without extension, of the missing batch files that missing products
        need.  If `certified` is true, only batches of certified maps are returned.  If `certified`
        is false, all other batches are returned."""
        return [path.stem for path, b in self._needed.items() if (b is None) == certified]

    def new_points(self) -> str:
        """Return the number of points and runs that jobs will compute.  Certified maps are not
        counted, because their points depend on the results."""
        blocks = [(path.parent, block) for path, block in self._needed.items() if block]
        most = sum(len(block.rows) * max(len(block.values), 1) for _, block in blocks)
        if most > MOST_COUNTED:
            return f"at most {most}"
        requests: dict[Path, list[dict]] = {}
        for folder, block in blocks:
            requests.setdefault(folder, []).extend(block.requests)
        return str(sum(len(Job(folder / "new").missing(own)) for folder, own in requests.items()))

    def order_of_batch(self, folder: str, name: str) -> str:
        """Return the JSON text that describes a batch for the job that solves this batch.  For a
        certified map, the text contains only the name of the map."""
        path = f"{folder}/{name.partition('-')[0]}"
        for product in self.missing:
            if path in (batches := self.plan.batches(product)):
                batch = batches[path]
                return canonical_json(product if batch is None else batch._asdict())
        raise SourcesEdited("the solver")

    def orders(self, *names: str) -> str:
        """Return the JSON text that lists the products made by a job; see
        products.make_products."""
        return canonical_json([[name, self.stems[name], self.missing[name]] for name in names])

    def plain(self) -> dict[str, tuple[str, str]]:
        """Return a dict that maps the plain name of each file to the name of the product and the
        path of the file."""
        return {
            plain: (name, f"data/{self.stems[name]}{ending}")
            for name, product in self.plan.products.items()
            for plain, ending in product.links.items()
        }

    def _chosen(self, folder: str, stem: str, endings: tuple[str, ...]) -> tuple[str, bool]:
        """Return a name, and whether complete files with this name exist.  If there are no complete
        files, an unused name is returned."""
        number = self._listed(folder).get(stem, {})
        for variant in sorted(number):
            if content.GAPS not in number[variant] and number[variant].issuperset(endings):
                paths = [self.folder / folder / f"{variant}{ending}" for ending in endings]
                if all(map(content.is_whole, paths)):
                    return variant, True
        names = (f"{stem}-{i}" if i else stem for i in count())
        return next(name for name in names if name not in number), False

    def _list(self, folder: str) -> dict[str, dict[str, set[str]]]:
        """Return the extensions of the files in a folder.  The outer key is the file name without
        its number.  The inner key is the file name with its number."""
        listed: dict[str, dict[str, set[str]]] = {}
        path = self.folder / folder
        for file in os.listdir(path) if self.here and path.is_dir() else ():
            name, dot, ending = file.rpartition(".")
            numbers = listed.setdefault(name.partition("-")[0], {})
            numbers.setdefault(name, set()).add(f"{dot}{ending}")
        return listed
