# Figures, from the datasets alone.


rule draw_figure:
    input:
        dataset=lambda wildcards: f"{RESULTS}/{FIGURES[wildcards.figure]}.nc",
        code=sorted(map(str, Path(PACKAGE, "plot").glob("*.py"))),
    output:
        expand(f"{RESULTS}/figures/{{{{figure}}}}.{{format}}", format=["png", "pdf"]),
    log:
        f"{RESULTS}/logs/draw_figure/{{figure}}.log",
    conda:
        "../envs/microslip.yaml"
    resources:
        mem_mb=500,
        runtime=10,
    params:
        name=lambda wildcards: FIGURES[wildcards.figure],
    script:
        "../scripts/draw_figure.py"
