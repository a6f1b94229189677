"""Two answers to the same question."""


def assert_agree(one, other, slack=0.0):
    """Both answers converged. Their gap is at most the sum of their error estimates and a slack."""
    assert one.converged and other.converged
    gap = abs(one.answer.value - other.answer.value)
    assert gap <= one.answer.error + other.answer.error + slack
