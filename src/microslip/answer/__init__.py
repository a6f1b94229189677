"""Public functions that make an answer: a number, a path or a period, with error estimates."""
