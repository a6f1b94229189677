"""The contact on rings and angular modes: rotation, and nu > 0."""
