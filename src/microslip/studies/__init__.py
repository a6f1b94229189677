"""Studies of accuracy and cost, of the stability of methods, and of the paper's claims."""
