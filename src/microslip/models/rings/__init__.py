"""The contact on rings, for translations at nu = 0."""
