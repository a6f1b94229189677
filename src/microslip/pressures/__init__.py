"""Normal contact: distributions of the load, and the friction bound at every point."""
