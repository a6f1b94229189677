"""Methods for comparison with the shipped one.  Each method is one file, see periodic.method."""
