# What the rules share: the checked configuration, and the batches it leads to.

from glob import glob

from snakemake.logging import logger as snakemake_log

from microslip import explorer, jobs, keys, plot, schemas, studies, sweep
from microslip.watch import Watch

# In a module the files are those of another workflow, which may hold more than this one knows.
FILES = [os.path.relpath(file) for file in workflow.configfiles] if MAIN else []
OVERRIDDEN = ["--config"] if MAIN and workflow.config_settings.config else []
OF_MODULE = "" if MAIN else f" of {workflow.modifier.namespace}"
# Where files are looked for that the configuration names, before the working directory.
FOLDERS = [os.path.dirname(os.path.abspath(file)) for file in workflow.configfiles]
ORIGIN = ", ".join([*FILES, *OVERRIDDEN]) or f"configuration{OF_MODULE}"

with refused_in_one_line(ORIGIN):
    for file in FILES:
        microslip_config.read_yaml(file)  # refuses a key that occurs twice
    # Jobs parse this again, and need not pay for asking the solver what it knows.
    places = {"source": ORIGIN, "folders": FOLDERS}
    CONFIGURATION = microslip_config.from_mapping(
        config, ask_solver=workflow.is_main_process, **places
    )
    # Captions name the defaults too, and jobs find the files that were found here.
    config = microslip_config.with_files_found(config, strict=workflow.is_main_process, **places)
    RESULTS = os.path.normpath(CONFIGURATION.results)
    # RESULTS with the prefix that a module may have; Snakemake adds it to the paths of rules itself.
    PLACE = str(workflow.modifier.modify_path(RESULTS))

DIGEST = keys.source_digest()
COUNTER = f"{PLACE}/logs/points_done"
PERIODS_PER_JOB = 150  # a few seconds of work

# BATCHES[group][name]: requests of that batch. A group is a sweep, or the single runs beside it.
BATCHES = {}
for name, grid in CONFIGURATION.sweeps.items():
    size = CONFIGURATION.points_per_job[name]
    BATCHES[name] = sweep.batches(sweep.PointRequests(grid), size, DIGEST)
    histories = sweep.history_requests(CONFIGURATION, name)
    BATCHES[f"{name}_histories"] = sweep.batches(histories, size, DIGEST)

# The studies by the names of their datasets. They cut their requests themselves; what takes long
# starts first, in jobs of its own.
STUDIES = {dataset: study for study, dataset in studies.DATASETS.items()}
for study in STUDIES.values():
    for group, cuts in zip((f"{study}_first", study), studies.pieces(study, CONFIGURATION)):
        batches = (sweep.batches(cut, len(cut), DIGEST) for cut in cuts)
        BATCHES[group] = {name: cut for batch in batches for name, cut in batch.items()}

# The periods that the explorer shows.
EXPLORED = explorer.maps_of(CONFIGURATION)
for name in EXPLORED:
    periods = explorer.period_requests(CONFIGURATION, name)
    BATCHES[f"{name}_periods"] = sweep.batches(periods, PERIODS_PER_JOB, DIGEST)

# Names of motions with numbers are read by the solver, so these are made when they are asked for:
# jobs for other sweeps do without it.
ON_DEMAND = dict.fromkeys(CONFIGURATION.extended)
EARLY = [f"{study}_first" for study in STUDIES.values()]


def batches_in(group):
    """The batches of a group by name."""
    if group in ON_DEMAND and ON_DEMAND[group] is None:
        points = sweep.PointRequests(CONFIGURATION.extended[group])
        ON_DEMAND[group] = sweep.batches(points, CONFIGURATION.points_per_job[group], DIGEST)
    return ON_DEMAND.get(group) or BATCHES[group]


# The figures that there is data for, each with the names of its datasets.
FIGURES = {
    figure: names
    for figure, names in plot.FIGURES.items()
    if all(name in CONFIGURATION.sweeps or name in STUDIES for name in names)
}
for figure in {"fig2_transverse_map", "fig6_bore_map", "poisson"} & FIGURES.keys():
    grids = [CONFIGURATION.sweeps[name] for name in FIGURES[figure]]
    drawable = all(grid.spans_a_map for grid in grids)
    if figure == "poisson":
        drawable &= all(1 < len(grid.poisson) <= plot.MOST_POISSONS for grid in grids)
    if not drawable:
        del FIGURES[figure]
FIGURES |= {plot.figure_of(group): names for group, names in CONFIGURATION.groups.items()}


def datasets_of(names):
    """Files of the datasets with these names, and the pages about them."""
    return expand(
        [f"{RESULTS}/{{name}}.nc", f"{RESULTS}/summaries/{{name}}.html"], name=list(names)
    )


def figures_of(datasets):
    """Files of all figures that are drawn from these datasets."""
    return [
        f"{RESULTS}/figures/{figure}.{form}"
        for figure, names in FIGURES.items()
        if set(names) <= set(datasets)
        for form in ("png", "pdf")
    ]


NAMES = [*CONFIGURATION.grids, *STUDIES]
PAGE = f"{RESULTS}/explorer.html"
FILES_MADE = [*datasets_of(NAMES), *figures_of(NAMES), PAGE]
MADE = [str(workflow.modifier.modify_path(path)) for path in FILES_MADE]
GROUPS = {"batches", "figures", "logs", "warm_up", *sweep.FOLDERS.values()}

with refused_in_one_line(ORIGIN):
    if workflow.is_main_process:
        cache.refuse_unusable([f"{PLACE}/{group}" for group in sorted(GROUPS)], MADE)
    # What is there is used again, so damage to it has to be seen before anything is planned; but
    # not while another run may be writing.
    if workflow.is_main_process and not glob(".snakemake/locks/*"):
        for path in cache.set_damaged_aside(MADE):
            print(f"{path} was damaged: renamed to {path}.damaged, made again", file=sys.stderr)

snakemake_log.addFilter(jobs.plain_words(PLACE))
WATCH = Watch(COUNTER)


def make_ready():
    """Before the first job: see that results can be written, clear what killed runs left."""
    with refused_in_one_line(ORIGIN):
        cache.Store(PLACE).try_writing()
    for path in cache.clear_abandoned(PLACE):
        print(f"{path} was left by a run that was killed: removed", file=sys.stderr)
    WATCH.start(points_to_do())


def points_to_do():
    """Points in the jobs that this run is about to do."""
    asked = [
        job.wildcards for job in workflow.dag.needrun_jobs() if "batch" in job.wildcards.keys()
    ]
    # Where this is a module, others may have batches too.
    known = [w for w in asked if w[0] in BATCHES or w[0] in ON_DEMAND]
    return sum(len(batches_in(w[0]).get(w.batch, ())) for w in known)


def show_the_end():
    """Stop the line of progress; say once more what is in the datasets, and what is not."""
    WATCH.stop()
    made = {path for job in workflow.dag.finished_jobs for path in job.output}
    names = [name for name in NAMES if f"{PLACE}/{name}.nc" in made]
    for line in jobs.closing_lines(PLACE, names):
        print(line, file=sys.stderr)


def batches_of(name):
    """Index files of a sweep's points and of the single runs in the same dataset."""
    return indices_of(name, *({f"{name}_histories"} & BATCHES.keys()))


def batches_of_study(dataset):
    """Index files of all that a study asks for; dataset: its name."""
    study = STUDIES[dataset]
    return indices_of(f"{study}_first", study)


def datasets_explored():
    """Files of the datasets that the explorer shows, if it can show them."""
    problem = explorer.refusal(CONFIGURATION)
    if problem:
        sys.exit(f"Error in {ORIGIN}: {problem}")
    return [f"{RESULTS}/{name}.nc" for name in EXPLORED]


def indices_of(*groups):
    """Index files of all batches of these groups."""
    return [
        f"{RESULTS}/batches/{group}/{batch}.json" for group in groups for batch in batches_in(group)
    ]


wildcard_constraints:
    sweep="|".join(CONFIGURATION.grids),
    dataset="|".join(STUDIES),
    group="|".join([*BATCHES, *ON_DEMAND]),
    early="|".join(EARLY),
    batch="[0-9a-f]+",
    figure="|".join(FIGURES),
