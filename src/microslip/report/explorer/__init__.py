"""One page for a browser that shows what is behind every point."""
