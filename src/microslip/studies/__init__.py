"""Studies of accuracy and cost, stability of methods, and claims of the paper."""
