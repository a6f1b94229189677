"""Files of the workflow besides its rules: captions, pages about datasets, layout."""

from functools import cache
from pathlib import Path
from types import SimpleNamespace

import pytest
import yaml

from microslip.config import load
from microslip.report import dataset_page
from microslip.report.figures import drawing

ROOT = Path(__file__).parents[2]


FIGURES = [*drawing.FIGURES, "extended_motions", "extended_static"]


@pytest.mark.parametrize("figure", FIGURES)
def test_every_figure_has_a_caption_of_its_own(figure):
    docutils = pytest.importorskip("docutils.core")
    caption = docutils.publish_string(
        rendered("figure", figure=figure), settings_overrides={"halt_level": 2}
    ).decode()
    others = [rendered("figure", figure=name) for name in FIGURES if name != figure]
    assert len(caption) > 200
    assert rendered("figure", figure=figure) not in others


DATASETS = ["bore", "circle", "certified_bore", "stability", "claims"]


@pytest.mark.parametrize("dataset", DATASETS)
def test_every_dataset_has_a_caption(dataset):
    assert "``results/any.nc``" in rendered("dataset", dataset=dataset)


@cache
def settings():
    """The default configuration with its defaults filled in."""
    mapping = load.read_yaml(ROOT / "config" / "config.yaml")
    return load.with_defaults_and_paths(mapping, folders=[ROOT / "config"])


@cache
def rendered(name, **wildcards):
    """A caption as rendered by Snakemake; undefined names raise an error."""
    jinja2 = pytest.importorskip("jinja2")
    environment = jinja2.Environment(undefined=jinja2.StrictUndefined, trim_blocks=True)
    snakemake = SimpleNamespace(
        wildcards=SimpleNamespace(**wildcards, keys=lambda: wildcards.keys()),
        config=settings(),
        input=["results/any.nc"],
        output=["results/any.nc"],
    )
    text = (ROOT / "workflow" / "report" / f"{name}.rst").read_text()
    return environment.from_string(text).render(snakemake=snakemake)


def test_a_page_about_a_dataset_lists_no_more_than_can_be_read():
    class Dataset:
        attrs, sizes = {"title": "Many", "configuration": '{"a": [1, 2]}'}, {"velocity": 3}

        def __contains__(self, name):
            return False

    page = dataset_page.page(Dataset(), [f"line {i}" for i in range(100)])
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
