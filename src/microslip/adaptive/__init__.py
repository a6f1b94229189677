"""Choice of the model and the resolution, and error estimates from many runs."""
