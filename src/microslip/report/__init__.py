"""Figures and pages from datasets. Nothing is computed here."""
