"""Option of the tests of the pages."""

import pytest


def pytest_addoption(parser: pytest.Parser) -> None:
    parser.addoption(
        "--rewrite",
        action="store_true",
        help="write what the blocks of the pages print now into the pages",
    )
