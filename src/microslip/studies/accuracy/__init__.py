"""What accuracy costs, method by method."""
