# Figures, from the datasets alone.

# snakemake fig2, or the name of any other figure.
for target, figure in figure_targets.targets_of(PLAN).items():

    rule:
        name:
            target
        input:
            files_of_figure(figure),


rule draw_figure:
    input:
        lambda wildcards: datasets_for(wildcards.figure),
    output:
        report(
            kept(f"{RESULTS}/figures/{{figure}}.png"),
            caption="../report/figure.rst",
            category=lambda wildcards: {
                "claims": "The paper's claims",
                "propulsion": "Self-propelled motions",
                **dict.fromkeys(CONFIGURATION.sweeps, "The paper's figures"),
                **dict.fromkeys(CONFIGURATION.extended, "Other motions and pressures"),
                **dict.fromkeys(CONFIGURATION.drives, "What pulls the contact"),
                **dict.fromkeys(CONFIGURATION.certified, "Certified maps"),
            }.get(FIGURES[wildcards.figure][0], "Methods"),
            labels={"figure": "{figure}"},
        ),
        kept(f"{RESULTS}/figures/{{figure}}.pdf"),
    log:
        f"{RESULTS}/logs/draw_figure/{{figure}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        names=lambda wildcards: FIGURES[wildcards.figure],
        made_of=lambda wildcards: PLAN.fingerprint_of(f"figures/{wildcards.figure}.png"),
        code=lambda wildcards: PLAN.code_of(f"figures/{wildcards.figure}.png"),
    script:
        "../scripts/draw_figure.py"
