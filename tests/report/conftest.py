"""Fixtures for tests of figures."""

import pytest
from matplotlib.layout_engine import ConstrainedLayoutEngine


@pytest.fixture
def without_layout(monkeypatch):
    """Leave out the layout of panels, which takes most of the time of a drawing."""
    monkeypatch.setattr(ConstrainedLayoutEngine, "execute", lambda *_: None)
