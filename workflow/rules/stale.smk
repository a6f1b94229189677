# What is there and has to be made again: of another configuration or other code, or damaged.

from glob import glob

from microslip.sweeps import batch_files, sealed_files

# Rules that seal what they make.
SEALING = ("collect", "collect_study", "collect_certified", "draw_figure")
SEALING += ("explorer", "explorer_all")
# Where another run may be writing, what looks damaged may be about to be whole.
ASKING = workflow.is_main_process and not glob(".snakemake/locks/*")


def look_after(*files):
    """Have Snakemake make these files again if they are not of what they are to be made of.

    Snakemake compares dates, and what it noted of the last run in a folder that may be gone or of
    another run. A seal goes with its file.
    """
    if STORED_ELSEWHERE and workflow.is_main_process:
        # There is no seal here to look at. Collecting again from batches takes little.
        # A module's rules have a prefix.
        sealing = (rule for rule in workflow.rules if rule.name.endswith(SEALING))
        workflow.dag.forcerules.update(sealing)
    for file in files:
        there = placed(file)
        if ASKING and os.path.lexists(there):
            if not sealed_files.is_made_of(there, PLAN.fingerprint_of(file)):
                make_again(there, "it is damaged" if sealed_files.is_damaged(there) else "")


def whole_batches(*groups):
    """Files of all batches of these groups; those that are damaged, or have points that failed for
    a reason that need not last, are made again."""
    files = PLAN.batch_files(*groups)
    for there in map(placed, files) if ASKING else ():
        why = os.path.lexists(there) and batch_files.why_not_whole(there)
        if why:
            make_again(there, why)
    return in_results(files)


def make_again(path, why=""):
    """Have Snakemake make a file in this run, if anything that is asked for depends on it."""
    if why and path not in workflow.dag.forcefiles:
        print(f"{path} is made again: {why}", file=sys.stderr)
    workflow.dag.forcefiles.add(path)
