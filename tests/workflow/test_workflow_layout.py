"""Files of the workflow besides its rules: captions, pages about datasets, layout."""

from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml

from microslip.config.kinds import KINDS
from microslip.report import pages

ROOT = Path(__file__).parents[2]


def configuration():
    """A configuration with all kinds of figures."""
    kinds = {kind: {"kind": kind, "sweep": "bore"} for kind in KINDS}
    return {"sweeps": {"bore": {"motion": "bore", "tolerance": 0.25}}, "figures": kinds}


@pytest.mark.parametrize("kind", KINDS)
def test_every_kind_of_figure_has_a_caption_of_its_own(kind):
    docutils = pytest.importorskip("docutils.core")
    page = "explorer" if kind == "explorer" else "figure"
    caption = docutils.publish_string(
        rendered(page, kind), settings_overrides={"halt_level": 2}
    ).decode()
    assert len(caption) > 200
    others = [rendered("figure", other) for other in KINDS if other not in (kind, "explorer")]
    assert rendered(page, kind) not in others


@pytest.mark.parametrize("dataset", ["bore", "accuracy", "claims"])
def test_every_dataset_has_a_caption(dataset):
    assert f"``{dataset}.nc``" in rendered("dataset", dataset)


def rendered(name, product):
    """A caption as rendered by Snakemake; undefined names raise an error."""
    jinja2 = pytest.importorskip("jinja2")
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, trim_blocks=True)
    snakemake = SimpleNamespace(
        wildcards=SimpleNamespace(stem=f"{product}.0123456789abcdef"),
        config=configuration(),
    )
    text = (ROOT / "workflow" / "report" / f"{name}.rst").read_text()
    return environment.from_string(text).render(snakemake=snakemake)


def test_a_page_about_a_dataset_lists_no_more_than_can_be_read():
    class Dataset:
        attrs, sizes = {"title": "Many", "configuration": '{"a": [1, 2]}'}, {"velocity": 3}

        def __contains__(self, name):
            return False

    page = pages.text_page(Dataset(), [f"line {i}" for i in range(100)])
    assert page.startswith("Many\n\nline 0\n")
    assert "line 39\n... and 60 lines more" in page
    assert page.endswith("a: [1, 2]\n")


# The layout that public catalogues of workflows expect


def test_the_layout_is_that_of_the_catalogue():
    usage = yaml.safe_load((ROOT / ".snakemake-workflow-catalog.yml").read_text())["usage"]
    assert usage["report"] is True
    assert usage["software-stack-deployment"]
    assert (ROOT / "workflow" / "Snakefile").is_file()
    assert list((ROOT / "workflow" / "rules").glob("*.smk"))
