"""Studies of accuracy and cost, failures of methods, and statements of the paper."""
