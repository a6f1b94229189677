"""Command-line option of the tests of the documentation."""

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--rewrite",
        action="store_true",
        help="write the present output of the blocks into the pages",
    )
