"""Squares: the compiled convolution against direct sums, and the step solver against a plain
one."""

import numpy as np
import pytest
from reference_march import solved_stage
from scipy.integrate import dblquad

from microslip.contact.contact import coulomb_residual, project
from microslip.contact.convolution import convolve, influence, square_convolution, workspace
from microslip.contact.squares import CartesianContact, DescentSolver
from microslip.theory.hertz import G_STAR

NUS = [0.0, 0.4]


@pytest.fixture
def rng():
    return np.random.default_rng(20201109)


# The convolution


def direct_sum(cells, nu, state):
    """Displacement as a sum over the tractions of all cells."""
    direct, cross = influence(cells, 2 * cells, nu)  # negative offsets at the end: index -1, -2, ..
    tractions = state[1] + 1j * state[0]
    out = np.zeros((cells, cells), complex)
    for i in range(cells):
        for j in range(cells):
            rows, columns = np.arange(cells)[:, None] - i, np.arange(cells)[None, :] - j
            out += (
                direct[rows, columns] * tractions[i, j]
                + cross[rows, columns] * tractions[i, j].conj()
            )
    return np.stack([out.imag, out.real])


@pytest.mark.parametrize("half_widths", [(1.0, 1.0), (1.0, 0.1), (0.4, 1.0)])
def test_influence_is_the_integral_of_cerrutis_solution(half_widths):
    nu, cells = 0.3, 4
    direct, cross = influence(cells, 2 * cells, nu, half_widths=half_widths)
    a, b = (2.0 * half / cells for half in half_widths)

    def integral(of, i, j):
        """Integral over the cell with the forward offset i and the lateral offset j."""
        sides = ((i - 0.5) * a, (i + 0.5) * a, (j - 0.5) * b, (j + 0.5) * b)
        return dblquad(lambda y, x: of(x, y) / np.hypot(x, y) ** 3, *sides)[0] / (np.pi * G_STAR)

    for i, j in [(1, 0), (0, -1), (2, 1), (-1, 3)]:
        parts = (
            integral(lambda x, y: x * x + y * y, i, j),
            nu / (2.0 - nu) * integral(lambda x, y: y * y - x * x, i, j),
            nu / (2.0 - nu) * integral(lambda x, y: 2.0 * x * y, i, j),
        )
        found = direct[i, j], cross[i, j].real, cross[i, j].imag
        assert found == pytest.approx(parts, abs=1e-9)


@pytest.mark.parametrize("nu", NUS)
@pytest.mark.parametrize("cells", [2, 3, 7, 12])
def test_convolution_is_linear_and_equal_to_the_direct_sum(cells, nu, rng):
    """Tractions are nonzero in all cells, including corners, where a cyclic convolution would
    differ."""
    operator = square_convolution(cells, nu)[0]
    state, out = rng.normal(size=(2, cells, cells)), np.empty((2, cells, cells))
    convolve(operator, workspace(operator), state, out)
    assert out == pytest.approx(direct_sum(cells, nu, state), abs=1e-13)


# One step


@pytest.mark.parametrize("nu", NUS)
@pytest.mark.parametrize("size", [0.03, 0.3, 5.0])
@pytest.mark.parametrize("cells", [5, 6])
def test_step_is_that_of_a_plain_solver(cells, size, nu, rng):
    """The plain solver has the dense matrix of direct sums."""
    contact = CartesianContact(cells, nu)
    units = np.eye(2 * cells**2).reshape(-1, 2, cells, cells)
    matrix = np.stack([direct_sum(cells, nu, unit).ravel() for unit in units], axis=1)
    b = size * rng.normal(size=(2, cells, cells))
    start = project(rng.normal(size=b.shape), contact.bound)
    q, slip, _, residual, _ = DescentSolver(contact, 1e-13).solve(b, start)
    assert residual <= 1e-13
    assert q == pytest.approx(solved_stage(matrix, b, contact.bound, 0.0 * b), abs=1e-11)
    assert slip == pytest.approx(b - direct_sum(cells, nu, q), abs=1e-13)
    total = coulomb_residual(q, slip, contact.bound, contact.weight, contact.compliance)
    assert total == pytest.approx(residual, abs=1e-14)
