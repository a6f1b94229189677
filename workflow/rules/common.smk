# What the rules share: the checked configuration, and the batches it leads to.

import atexit
import functools
from itertools import count

from snakemake.io import get_flag_value
from snakemake.logging import logger as snakemake_log

from microslip.app import dry_run, figure_targets, job_log, plan
from microslip.app.bucket import Bucket
from microslip.app.plan import Plan
from microslip.app.progress import Watch
from microslip.config import schema
from microslip.foundation import canonical, machine, source_digest
from microslip.report.explorer import explorer
from microslip.sweeps import batch_plans, batches, cache, map_rounds

# In a module the files are those of another workflow, which may hold more than this one knows.
FILES = [os.path.relpath(file) for file in workflow.configfiles] if MAIN else []
OVERRIDDEN = ["--config"] if MAIN and workflow.config_settings.config else []
OF_MODULE = "" if MAIN else f" of {workflow.modifier.namespace}"
# Where files are looked for that the configuration names, before the working directory.
FOLDERS = [os.path.dirname(os.path.abspath(file)) for file in workflow.configfiles]
ORIGIN = ", ".join([*FILES, *OVERRIDDEN]) or f"configuration{OF_MODULE}"

with refused_in_one_line(ORIGIN):
    for file in FILES:
        load.read_yaml(file)  # refuses a key that occurs twice
    # Jobs parse this again, and need not pay for asking the solver what it knows.
    places = {"source": ORIGIN, "folders": FOLDERS}
    CONFIGURATION = load.from_mapping(config, ask_solver=workflow.is_main_process, **places)
    # Captions name the defaults too, and jobs find the files that were found here.
    config = load.with_files_found(config, strict=workflow.is_main_process, **places)
    RESULTS = os.path.normpath(CONFIGURATION.results)
    # RESULTS with the prefix that a module may have; Snakemake adds it to the paths of rules itself.
    PLACE = str(workflow.modifier.modify_path(RESULTS))

STORED_ELSEWHERE = workflow.storage_settings.default_storage_provider is not None


def stored(file):
    """Where Snakemake keeps a file of the folder of results that is elsewhere."""
    return get_flag_value(workflow.modifier.modify_path(f"{RESULTS}/{file}"), "storage_object")


EARLIER = (
    Bucket(stored)
    if STORED_ELSEWHERE
    else batch_plans.Folder(PLACE, forgets=workflow.is_main_process)
)
PLAN = Plan(CONFIGURATION, EARLIER)
COUNTER = f"{PLACE}/logs/points_done"
STUDIES = PLAN.studies
EXPLORED = PLAN.explored
EARLY = PLAN.early_groups
FIGURES = PLAN.figures
NAMES = PLAN.datasets
# A certified map needs a folder of results on this machine, and a page does without it.
ANSWERING = [] if STORED_ELSEWHERE else explorer.certified_of(CONFIGURATION)


def kept(file):
    """An output whose former state stays until the new one is whole.

    In a bucket it does anyway, since what is new is uploaded when it is whole. Snakemake would look
    for it on this machine.
    """
    return file if STORED_ELSEWHERE else update(file)


def in_results(files):
    """The files with the folder of results before them."""
    return [f"{RESULTS}/{file}" for file in files]


def placed(file):
    """Path of a file in the folder of results, with the prefix that a module may have."""
    return f"{PLACE}/{file}"


def datasets_of(names):
    """Files of the datasets with these names, and the pages about them."""
    return in_results(PLAN.dataset_files(names))


def figures_of(datasets):
    """Files of all figures that are drawn from these datasets."""
    return in_results(PLAN.figure_files(datasets))


def kernels_of(name):
    """What has to be compiled for a sweep or a certified map."""
    pulled = [*CONFIGURATION.drives, *(f"certified_{sweep}" for sweep in CONFIGURATION.drives)]
    compiled = [*rules.warm_up.output, *rules.warm_up_angles.output]
    return [*compiled, *rules.warm_up_pulled.output] if name in pulled else compiled


def requests_of(group, batch):
    """Requests of a batch as one string: Snakemake compares parameters as a set and would miss two
    swapped numbers."""
    if workflow.is_main_process:
        requests = PLAN.batches_in(group).get(batch)
    else:
        requests = PLAN.requests_of(group, batch)
    if requests is None:  # in a job, where the sources or the CPU are not those of the plan
        if group in PLAN.groups_of("accuracy_cost"):
            sys.exit(
                f"Error: {group}: times on {machine.cpu_model()} were not planned; the solver was "
                "edited, or the plan was made on another CPU: plan and time on the same model"
            )
        sys.exit(f"Error: {batches.SourcesEdited('the solver')}")
    return canonical.canonical_json(requests)


def batches_for(dataset):
    """Files of the batches that a dataset is made of."""
    look_after(*PLAN.dataset_files([dataset]))
    return whole_batches(*PLAN.groups_of(dataset))


def histories_for(name):
    """Files of the batches of the single runs beside a sweep."""
    return whole_batches(*PLAN.groups_beside(name))


@functools.cache
def damaged_rounds(name):
    """Files of the rounds of a map that this run has to make again, and why.

    They are looked at once, before any of them is made in this run.
    """
    paths = glob(f"{placed(PLAN.rounds_folder(name))}/*.json") if ASKING else ()
    reasons = {path: map_rounds.why_not_whole(path) for path in paths}
    return {path: why for path, why in reasons.items() if why}


def round_files(name):
    """Files of the rounds of a map, one by one; Snakemake goes on here when the next is there."""
    if STORED_ELSEWHERE:
        sys.exit(f"Error in {ORIGIN}: {name} needs a folder of results on this machine")
    for number in count():
        path = f"{placed(PLAN.rounds_folder(name))}/{number}.json"
        if workflow.is_main_process:
            if path in damaged_rounds(name):
                make_again(path, damaged_rounds(name)[path])
            chosen = os.path.basename(PLAN.rounds_folder(name))
            checkpoints.next_round.get(certified=name, chosen=chosen, round=number)
        yield path


def answered_rounds(name, most):
    """Files of the rounds of a map that have points, `most` of them at most; and of the batches
    that answer them."""
    rounds, batches_there = [], []
    for number, path in zip(range(most), round_files(name)):
        parts = map_rounds.read_round(path)["parts"]
        if not parts:
            break
        folder = PLAN.rounds_folder(name)
        files = [f"{folder}/{number}-{part}.json" for part in range(parts)]
        for file in map(placed, files):
            if file in damaged_rounds(name):
                make_again(file, damaged_rounds(name)[file])
        rounds.append(f"{RESULTS}/{folder}/{number}.json")
        batches_there += in_results(files)
    return {"rounds": rounds, "batches": batches_there}


def all_rounds(wildcards):
    """All that a map is made of."""
    look_after(*PLAN.dataset_files([wildcards.certified]))
    return answered_rounds(wildcards.certified, map_rounds.MOST_ROUNDS)


def datasets_for(figure):
    """Files of the datasets that a figure is drawn from."""
    look_after(*(f"figures/{figure}.{form}" for form in ("png", "pdf")))
    return in_results(f"{name}.nc" for name in FIGURES[figure])


GROUPS = {"batches", "rounds", "figures", "logs", "warm_up", *batches.FOLDERS.values()}

with refused_in_one_line(ORIGIN):
    if workflow.is_main_process:
        folders = [placed(group) for group in sorted(GROUPS)]
        sealed_files.refuse_unusable(folders, map(placed, PLAN.made_files()))

snakemake_log.addFilter(job_log.plain_words(PLACE))
WATCH = Watch(COUNTER)


def make_ready():
    """Before the first job: see that results can be written, note the new batches, clear what
    killed runs left."""
    with refused_in_one_line(ORIGIN):
        cache.Store(PLACE).try_writing()
        PLAN.keep_planned()
    for path in sealed_files.clear_abandoned(PLACE):
        print(f"{path} was left by a run that was killed: removed", file=sys.stderr)
    WATCH.start(points_to_do())


def planned_jobs():
    """Jobs of this run, finished or not: a dry run takes all of them for finished at its end."""
    return list(workflow.dag.needrun_jobs(exclude_finished=False))


def has_rounds():
    """Whether the jobs of this run refine a certified map."""
    return any("round" in job.wildcards.keys() for job in planned_jobs())


def batches_to_do():
    """Group and requests of each batch that this run solves."""
    jobs = planned_jobs()
    asked = [job.wildcards for job in jobs if "batch" in job.wildcards.keys()]
    # Where this is a module, others may have batches too.
    known = [w for w in asked if w[0] in PLAN.groups]
    return [(w[0], PLAN.batches_in(w[0]).get(w.batch, ())) for w in known]


def points_to_do():
    """Number of points in the jobs of this run; None if a round of a certified map is among them,
    since its answers decide how many follow."""
    return None if has_rounds() else sum(len(requests) for _, requests in batches_to_do())


def tell_work():
    """At the end of a dry run: how many points there are to solve, and about how long it takes."""
    planned = workflow.is_main_process and workflow.scheduler is not None and workflow.dryrun
    jobs = planned_jobs() if planned else []
    if not jobs:
        return
    work = batches_to_do()
    # Of -j 2 a dry run makes one core and two nodes; -j unlimited is sys.maxsize.
    cores = workflow.resource_settings.nodes or workflow.resource_settings.cores or 1
    cores = cores if cores < sys.maxsize else max(len(work), 1)
    compiles = any("warm_up" in job.rule.name for job in jobs)
    for line in dry_run.summary(work, PLACE, cores, compiles=compiles, rounds=has_rounds()):
        print(line, file=sys.stderr)


if MAIN:
    atexit.register(tell_work)


def show_the_end():
    """Stop the line of progress; say once more what is in the datasets, and what is not."""
    WATCH.stop()
    made = {path for job in workflow.dag.finished_jobs for path in job.output}
    names = [name for name in NAMES if f"{PLACE}/{name}.nc" in made]
    for line in job_log.closing_lines(PLACE, names):
        print(line, file=sys.stderr)


def datasets_explored(page):
    """Files of the datasets that a page of the explorer shows, if it can show them."""
    look_after(page)
    problem = explorer.refusal(CONFIGURATION, page)
    if problem:
        sys.exit(f"Error in {ORIGIN}: {problem}")
    return in_results(f"{name}.nc" for name in explorer.sweeps_of(CONFIGURATION, page))


wildcard_constraints:
    sweep="|".join(CONFIGURATION.grids),
    dataset="|".join(STUDIES),
    certified="|".join(CONFIGURATION.certified) or "(?!)",  # nothing, where there is none
    chosen="[0-9a-f]+",
    round="[0-9]+",
    part="[0-9]+",
    group="|".join(PLAN.groups),
    early="|".join(EARLY),
    batch="[0-9a-f]+",
    figure="|".join(FIGURES),


def files_of_figure(name):
    """Input function of the target that makes one figure."""

    def files(wildcards):
        if name not in FIGURES:
            sys.exit(f"Error in {ORIGIN}: {figure_targets.why_no_figure(PLAN, name)}")
        return in_results(f"figures/{name}.{form}" for form in ("png", "pdf"))

    return files
