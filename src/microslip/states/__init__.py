"""States that a contact settles into: periodic, steady, static."""
