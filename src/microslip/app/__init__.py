"""The command line, the plan of a run, and the start and end of a process."""
