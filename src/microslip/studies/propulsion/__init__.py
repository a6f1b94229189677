"""What motions drive."""
