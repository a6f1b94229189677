"""One run at one resolution: its periodic, steady or static state."""
