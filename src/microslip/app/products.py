"""Make products: datasets with their pages, figures, and pages of the explorer."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from microslip.app.plan import Plan
from microslip.config import load
from microslip.foundation.files import write_atomically
from microslip.sweeps import batch, content
from microslip.sweeps.request import is_settled

log = logging.getLogger("microslip")


def make_products(job: Any) -> None:
    """Make the products of a job, one after the other.

    job: the variable `snakemake` of a script.  The parameter `products` of the job is a JSON list.
    Each item contains the name of a product, the stem of its files, and its inputs.  Paths are
    relative to the folder of results.

    If one product fails, the other products are still made.  The first error is raised at the end.
    """
    plan = Plan(load.from_mapping(job.config))
    folder = Path(job.output[0].rpartition("/data/")[0])
    errors = []
    for name, stem, inputs in json.loads(job.params.products):
        try:
            make(plan, name, folder / "data" / stem, [folder / path for path in inputs])
        except Exception as error:
            error.add_note(f"while making {name}")
            errors.append(error)
            if len(errors) > 1:
                log.error("%s: %s: %s", name, type(error).__name__, error)
    if errors:
        raise errors[0]


def make(plan: Plan, name: str, stem: Path, inputs: list[Path]) -> None:
    """Make the files of a product.  The plain names of the product become links to these files.

    stem: path, without extension, of the files.  inputs: datasets, then batch files.

    Raises SourcesEdited if the code has changed since the job was planned.
    """
    product = plan.products[name]
    if stem.name.partition("-")[0] != product.stem:
        raise batch.SourcesEdited("the code that makes it")
    files = {end: stem.parent / f"{stem.name}{end}" for end in product.links.values()}
    is_dataset = name in plan.configuration.datasets
    (_make_dataset if is_dataset else _make_figure)(plan, name, files, inputs)
    for plain, ending in product.links.items():
        content.remove_others(files[ending])
        content.link(files[ending], stem.parents[1] / plain)


def _make_dataset(plan: Plan, name: str, files: dict[str, Path], inputs: list[Path]) -> None:
    from microslip.datasets import certified_map, netcdf, sweep_dataset
    from microslip.report import pages
    from microslip.studies import registry

    configuration, failed = plan.configuration, []

    def records() -> Iterator[dict]:
        for record in batch.records_in(inputs):
            if not is_settled(record["result"]):
                failed.append(record)
            yield record

    builders = {"sweep": sweep_dataset, "certified": certified_map}
    builder: Any = builders.get(plan.products[name].kind, registry)
    root, groups = builder.build(configuration, name, records())
    marker = files[".nc"].with_suffix(content.GAPS)
    if failed:
        marker.parent.mkdir(parents=True, exist_ok=True)
        marker.touch()
    netcdf.write(files[".nc"], root, groups)
    shown = netcdf.whole(files[".nc"]) if builder is registry else root
    lines = list(builder.report(shown, name))
    write_atomically(files[".html"], pages.page(shown, lines).encode())
    for line in lines:
        log.info(line)


def _make_figure(plan: Plan, name: str, files: dict[str, Path], inputs: list[Path]) -> None:
    from microslip.report.figures import drawing

    configuration, figure = plan.configuration, plan.configuration.figures[name]
    datasets = dict(zip(figure.datasets, map(drawing.loaded, inputs), strict=False))
    if figure.kind != "explorer":
        drawn = drawing.draw(figure.kind, datasets)
        for path in files.values():
            drawing.save(drawn, path)
        return
    from microslip.report.explorer import explorer, page

    answer = batch.lookup(batch.records_in(inputs[len(datasets) :]))
    maps = explorer.maps_of(configuration, figure)
    periods = {
        one: [answer(r) for r in explorer.period_requests(configuration, *maps, name=one)]
        for one in maps
    }
    certified = [
        datasets.pop(one) for one in figure.sweep if configuration.sweeps[one].is_certified
    ]
    text = page.page(page.build(datasets, periods, certified))
    write_atomically(files[".html"], text.encode())
    for line in explorer.report(periods):
        log.info(line)
