"""Captions of the report, and pages about datasets."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import xarray as xr

from microslip.config.kinds import KINDS
from microslip.report import pages

CAPTIONS = Path(__file__).parents[2] / "workflow" / "report"


DATASETS = ("bore", "certified", "accuracy", "claims")


@pytest.mark.parametrize("product", [*KINDS, *DATASETS])
def test_every_product_has_a_caption_of_its_own(product):
    """Captions are rendered as by Snakemake; undefined names and bad markup raise errors."""
    docutils = pytest.importorskip("docutils.core")
    jinja2 = pytest.importorskip("jinja2")
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, trim_blocks=True)
    kinds = {kind: {"kind": kind, "sweep": "bore"} for kind in KINDS}
    sweeps = {"bore": {"motion": "bore"}, "certified": {"motion": "bore", "error": 0.1}}

    def rendered(name, stem):
        text = (CAPTIONS / f"{name}.rst").read_text()
        snakemake = SimpleNamespace(
            wildcards=SimpleNamespace(stem=f"{stem}.0123456789abcdef"),
            config={"sweeps": sweeps, "figures": kinds},
        )
        return environment.from_string(text).render(snakemake=snakemake)

    of = product if product == "explorer" else "figure" if product in KINDS else "dataset"
    caption = rendered(of, product)
    assert len(docutils.publish_string(caption, settings_overrides={"halt_level": 2})) > 200
    others = {*(KINDS if product in KINDS else DATASETS)} - {product, "explorer"}
    kind = "figure" if product in KINDS else "dataset"
    assert caption not in [rendered(kind, one).replace(one, product) for one in others]
    assert product in KINDS or f"``{product}.nc``" in caption


def test_a_page_about_a_dataset_lists_no_more_than_can_be_read():
    dataset = xr.Dataset(attrs={"title": "Many", "configuration": '{"a": [1, 2]}'})
    page = pages.text_page(dataset, [f"line {i}" for i in range(100)])
    assert page.startswith("Many\n\nline 0\n")
    assert "line 39\n... and 60 lines more" in page
    assert page.endswith("a: [1, 2]\n")
