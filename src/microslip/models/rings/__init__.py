"""The contact on rings: motion along one line at nu = 0."""
