"""The contact on square cells, for any outline and any motion."""
