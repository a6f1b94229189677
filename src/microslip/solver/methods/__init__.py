"""Methods to compare with the one that ships: one file a method, see method_names."""
