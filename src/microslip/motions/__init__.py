"""Prescribed kinematics: a motion is one file."""
