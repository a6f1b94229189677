"""The contact on rings and angular modes, for rotations and for nu > 0."""
