"""Study of self-propelled motions."""
