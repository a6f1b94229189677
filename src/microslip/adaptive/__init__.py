"""Many runs: the model, the resolution and the error of an answer."""
