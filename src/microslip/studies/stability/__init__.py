"""Where methods fail."""
