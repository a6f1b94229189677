"""The command line, the plan of a run, and how a process starts and ends."""
