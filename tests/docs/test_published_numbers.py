"""Numbers and formulas that others have published, see benchmarks/published_numbers.py."""

import numpy as np
import pytest
from stubs.benchmark import ROOT, module

numbers = module("published_numbers")
CASES = numbers.NUMBERS["CONTACT"]["cases"]
TMDSIMPY = numbers.NUMBERS["tmdsimpy"]


def of_case(case):
    return case["name"]


def disagreements(comparisons):
    return [one.what for one in comparisons if not one.agrees]


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=of_case)
def test_contact_on_its_own_elements_to_the_last_printed_digit(case):
    differ = disagreements(numbers.contact_on_its_elements(case))
    assert set(differ) <= {"stiffness lateral"}  # a quotient of the first iterations of CONTACT


@pytest.mark.slow
def test_tractions_of_contact_on_all_elements_to_the_last_printed_digit():
    assert disagreements(numbers.contact_tractions()) == []


@pytest.mark.slow
@pytest.mark.parametrize("case", CASES, ids=of_case)
def test_contact_on_a_refined_mesh(case):
    assert disagreements(numbers.contact_refined(case)) == []


@pytest.mark.long
def test_stiffness_and_energy_of_closed_forms():
    assert disagreements(numbers.closed_forms()) == []


def force_of_springs(displacement, height, count=4000):
    """Force of independent springs at |x| < sqrt(height), which is exact for a sphere at nu = 0.

    A spring at x yields at the stretch height - x^2. Between two rows all quantities are linear, so
    a spring ends at the smaller of its stretch without slip and its yield stretch.
    """
    width, stretch, forces = np.sqrt(height.max()) / count, np.zeros(count), [0.0]
    x = (np.arange(count) + 0.5) * width
    for step, depth in zip(np.diff(displacement), height[1:], strict=True):
        bound = np.maximum(depth - x**2, 0.0)
        stretch = np.clip(stretch + step, -bound, bound)
        forces.append(1.5 * stretch.sum() * width)
    return np.array(forces)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("name", "least", "most"),
    [
        ("constant_load", 0.0, numbers.SLIDERS),
        ("decreasing_load", 0.04, 0.05),
        ("increasing_load", 0.02, 0.03),
    ],
)
def test_joint_model_is_near_at_constant_load_only(name, least, most):
    published, answer = numbers.tmdsimpy_loop(name)
    loop = TMDSIMPY["loops"][name]
    path, height = answer.problem.motion.rows[:, 0], np.array(loop["approach_m"])
    exact = force_of_springs(path, height / height[0])
    assert np.all(np.abs(answer.force_forward - exact) <= answer.force_error[:, 0])
    assert least <= np.abs(published - exact).max() <= most
    load = np.array(loop["load_N"])
    assert load / load[0] == pytest.approx((height / height[0]) ** 1.5)  # Hertz


@pytest.mark.long
@pytest.mark.parametrize("name", numbers.WAVEFORMS)
def test_formulas_of_popov_for_a_flat_end(name):
    assert numbers.popov_waveform(name, 1.0).agrees


def test_static_friction_of_popov_under_an_oscillating_force_is_that_of_the_page():
    comparisons = numbers.popov_static()
    differ = disagreements(comparisons)
    assert differ == ["static, lateral force (Eq 8), sphere"]  # it creeps by partial slip
    text = (ROOT / "docs/measured/published_numbers.md").read_text(encoding="utf-8")
    rows = numbers.tables.markdown([one.row() for one in comparisons]).splitlines()[2:]
    assert all(row in text for row in rows)


def test_a_fit_to_luo_explains_the_size_of_the_reduction_but_not_the_reduction_at_rest():
    u_lim, comparisons = numbers.luo()
    assert 0.4e-6 < u_lim < 0.6e-6
    rest, low, high, rigid = comparisons
    assert low.published < low.computed < high.computed < high.published
    assert rest.computed > high.computed > rest.published
    assert rigid.computed > 0.99
