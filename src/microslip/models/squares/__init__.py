"""The contact on squares: any outline, any motion."""
