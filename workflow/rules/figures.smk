# Figures, from the datasets alone.


rule draw_figure:
    input:
        lambda wildcards: [f"{RESULTS}/{name}.nc" for name in FIGURES[wildcards.figure]],
    output:
        report(
            f"{RESULTS}/figures/{{figure}}.png",
            caption="../report/figure.rst",
            category=lambda wildcards: {
                "claims": "The paper's claims",
                **dict.fromkeys(CONFIGURATION.sweeps, "The paper's figures"),
                **dict.fromkeys(CONFIGURATION.extended, "Other motions and pressures"),
            }.get(FIGURES[wildcards.figure][0], "Methods"),
            labels={"figure": "{figure}"},
        ),
        f"{RESULTS}/figures/{{figure}}.pdf",
    log:
        f"{RESULTS}/logs/draw_figure/{{figure}}.log",
    conda:
        "../envs/microslip.yaml"
    threads: 1
    resources:
        mem_mb=lambda wildcards, attempt: 1000 * attempt,
        runtime=lambda wildcards, attempt: 10 * attempt,
    params:
        names=lambda wildcards: FIGURES[wildcards.figure],
        # Not read by the script; it makes Snakemake notice a change.
        code=lambda wildcards: keys.digest_of_modules("plot"),
    script:
        "../scripts/draw_figure.py"
