"""Study of the cost of accuracy, method by method."""
