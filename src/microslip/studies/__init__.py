"""Studies of accuracy and cost, stability of methods, claims of the paper, and propulsion."""
