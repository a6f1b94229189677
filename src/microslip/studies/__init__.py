"""What accuracy costs, where methods fail, which of the paper's claims hold."""
