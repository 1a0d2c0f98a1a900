"""What kernels do with arrays number by number, beside numpy, compiled and plain."""

from __future__ import annotations

import sys

import numba
import numpy as np
import pytest

from cqdd_design.files import kernel_part
from cqdd_design.files.kernel_arrays import (
    greatest,
    greatest_of_rows,
    put,
    put_rows,
    sum_of_squares,
)


def compiled(function):
    """The function as a kernel calls it."""
    return numba.njit(error_model="numpy")(lambda *values: function(*values))


@pytest.fixture(params=[False, True], ids=["plain", "compiled"])
def called(request):
    return compiled if request.param else lambda function: function


def test_copies_leave_what_is_beyond(called):
    into = np.arange(5.0)
    called(put)(into, np.array([7.0, 8.0]))
    assert into.tolist() == [7.0, 8.0, 2.0, 3.0, 4.0]
    rows = np.zeros((2, 3))
    called(put_rows)(rows, np.arange(6.0).reshape(2, 3))
    assert rows.tolist() == [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0]]


def test_greatest_is_by_size_and_no_number_is_passed_over(called):
    values = np.array([[1.0, -4.0], [3.0, 2.0]])
    assert called(greatest)(values[0]) == 4.0
    assert called(greatest_of_rows)(values) == 4.0
    assert called(sum_of_squares)(values[0]) == 17.0
    for i, j in np.ndindex(2, 2):
        spoilt = values.copy()
        spoilt[i, j] = np.nan
        assert np.isnan(called(greatest)(spoilt[i]))
        assert np.isnan(called(greatest_of_rows)(spoilt))


def test_nobody_counts_what_is_borrowed_and_none_is_made_on_credit():
    @kernel_part.part(borrows=True)
    def raised(values):
        for view in (values[0], values[1]):
            for i in range(view.shape[0]):
                view[i] += 1.0

    @kernel_part.part(borrows=True)
    def made(count):
        return np.empty(count).sum()

    @numba.njit(error_model="numpy")
    def kernel(values, rounds):
        for _ in range(rounds):
            raised(values)

    values = np.zeros((2, 3))
    before = sys.getrefcount(values)
    kernel(values, 1000)
    assert sys.getrefcount(values) == before
    assert (values == 1000.0).all()
    text = "\n".join(kernel.inspect_llvm().values())
    assert text.count("call void @NRT_incref") <= 1
    with pytest.raises(numba.core.errors.NumbaError, match="No implementation"):
        compiled(made)(3)
