"""A configuration, read and checked."""
