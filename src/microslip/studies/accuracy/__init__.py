"""Study of the accuracy and the cost of each model and method."""
