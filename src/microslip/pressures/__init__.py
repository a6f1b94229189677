"""Normal contact: how the load is spread, and so what friction every point can take."""
