"""Fields of every result of a point."""

CONTRACT = {
    "motion",
    "velocity",
    "poisson",
    "model",
    "mu_macro",
    "mu_macro_error",
    "converged",
    "cells",
    "steps_per_period",
    "periods",
    "solve_time_s",
}
