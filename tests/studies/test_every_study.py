"""Requests and file conventions of all studies."""

import json

import pytest
import xarray as xr
from stubs import claims_stub, studies_stub

from microslip.datasets import netcdf
from microslip.foundation.canonical import canonical_json
from microslip.studies import registry

STUDIES = {
    "accuracy": (studies_stub.configured, studies_stub.accuracy_result),
    "stability": (studies_stub.configured, studies_stub.stability_result),
    "claims": (claims_stub.configured, claims_stub.result),
}


def answered(study):
    """Dataset of a study with invented results, and its requests."""
    configured, results = STUDIES[study]
    answer, calls = studies_stub.answered(results)
    return registry.undivided(configured(), study, answer), calls


@pytest.fixture(scope="module", params=STUDIES)
def file(request, tmp_path_factory):
    """Name of a study, and the file of its dataset."""
    study = request.param
    path = tmp_path_factory.mktemp(study) / f"{study}.nc"
    netcdf.write(path, *registry.divided(answered(study)[0], study))
    return study, path


@pytest.mark.parametrize("study", STUDIES)
def test_a_dataset_asks_for_what_jobs_have_answered_and_for_all_of_it(study):
    pieces = registry.pieces(study, STUDIES[study][0]().studies[study])
    of_jobs = [canonical_json(request) for piece in pieces for request in piece]
    assert set(answered(study)[1]) == set(of_jobs)


def test_every_part_of_a_file_is_a_table_of_its_own(file):
    _, path = file
    for group in (None, *netcdf.group_names(path)):
        with xr.open_dataset(path, group=group) as part:
            assert len(part.to_dataframe()) == max(v.size for v in part.values()), group


def test_conventions_and_provenance(file):
    study, path = file
    data = netcdf.whole(path)
    for name, variable in data.variables.items():
        assert variable.attrs["long_name"], name
        flags = "flag_meanings" in variable.attrs or variable.dtype == bool
        if variable.dtype.kind in "if" and not flags:
            assert variable.attrs["units"] in ("1", "s", "byte", "rad"), name
        if f"{name}_error" in data.variables:
            assert variable.attrs["ancillary_variables"] == f"{name}_error"
    assert data.Conventions == "CF-1.11"
    assert data.source and data.institution
    assert len(data.source_digest) == len(data.results_digest) == 64
    settings = getattr(STUDIES[study][0](), study)
    assert settings.model_dump(mode="json") == json.loads(data.configuration)
    assert data.library_versions == '{"numpy":"2.0"}'


def test_equal_results_give_equal_bytes(file, tmp_path):
    study, path = file
    netcdf.write(tmp_path / "again.nc", *registry.divided(answered(study)[0], study))
    assert (tmp_path / "again.nc").read_bytes() == path.read_bytes()
