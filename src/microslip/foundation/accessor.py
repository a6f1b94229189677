"""The accessor `microslip` of xarray datasets.

`import microslip` registers the accessor, so that it is available for maps that are opened by
`xarray.open_dataset(...)`.  Importing xarray takes a third of a second.  To save this time in
processes without datasets, the accessor is registered only when xarray is imported.
"""

import sys
from importlib import import_module
from importlib.machinery import ModuleSpec
from importlib.util import find_spec
from types import ModuleType
from typing import Any


def register() -> None:
    """Register the accessor now if xarray is already imported.  Otherwise, register the accessor on
    the import of xarray."""
    if "xarray" in sys.modules:
        _register(sys.modules["xarray"])
    else:
        sys.meta_path.insert(0, _AfterXarray())


class _AfterXarray:
    """Finder of Python's import system.  It registers the accessor once xarray is imported."""

    def find_spec(self, name: str, path: object = None, target: object = None) -> ModuleSpec | None:
        if name != "xarray":
            return None
        sys.meta_path.remove(self)
        spec = find_spec(name)
        if spec is not None and spec.loader is not None:
            execute = spec.loader.exec_module

            def exec_module(module: ModuleType) -> None:
                execute(module)
                _register(module)

            spec.loader.exec_module = exec_module  # type: ignore[method-assign]
        return spec


def _register(xarray: Any) -> None:
    def of_dataset(dataset: Any) -> Any:
        return import_module("microslip.datasets.accessor").Map(dataset)

    if not hasattr(xarray.Dataset, "microslip"):  # the package may be imported anew
        xarray.register_dataset_accessor("microslip")(of_dataset)
