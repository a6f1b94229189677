"""Studies of accuracy and cost, of the failures of methods, and of the statements of the paper."""
