"""Closed forms and bounds for friction. The subpackage depends neither on the solver nor on files
or plots."""
