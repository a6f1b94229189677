"""Figures and pages of datasets. This package computes no results."""
