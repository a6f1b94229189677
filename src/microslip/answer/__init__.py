"""Public functions that return a result (a number, a path or a period) with error estimates."""
