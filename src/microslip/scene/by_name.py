"""Motions by name."""

from __future__ import annotations

from microslip.foundation.named_files import Family
from microslip.scene.from_file import create_samples
from microslip.scene.motion import Motion
from microslip.scene.named import NAMED

motion_named = Family("motion", Motion, NAMED, create_samples)
"""Function that returns the motion for a text such as "elliptic:forward=0.5,phase=90",
"file:stroke.csv" or "mine/soft_square.py"."""
MOTIONS = motion_named.classes
"""Name -> subclass of Motion, for the motions of the package."""
