"""Study of the paper's claims."""
