"""Copies and greatest numbers of arrays within kernels, number by number.

With a slice assignment numba also compiles the sentence about shapes that do not match, numbers to
text and all, which takes a kernel two to four seconds more; each of its own reductions takes half a
second.
"""

from __future__ import annotations

from typing import Any

from cqdd_design.files.kernel_part import part


@part(borrows=True, forceinline=True)
def put(into: Any, values: Any) -> None:
    """Copy an array of one axis into one at least as long."""
    for i in range(values.shape[0]):
        into[i] = values[i]


@part(borrows=True, forceinline=True)
def put_rows(into: Any, values: Any) -> None:
    """Copy an array of two axes into one of the same shape."""
    for i in range(values.shape[0]):
        for k in range(values.shape[1]):
            into[i, k] = values[i, k]


@part(borrows=True, forceinline=True)
def greatest(values: Any) -> float:
    """Greatest absolute number of an array of one axis; not a number where one is none."""
    found = 0.0
    for i in range(values.shape[0]):
        value = abs(values[i])
        if value > found or value != value:
            found = value
    return found


@part(borrows=True, forceinline=True)
def sum_of_squares(values: Any) -> float:
    """Sum of the squares of an array of one axis."""
    total = 0.0
    for i in range(values.shape[0]):
        total += values[i] * values[i]
    return total


@part(borrows=True, forceinline=True)
def greatest_of_rows(values: Any) -> float:
    """Greatest absolute number of an array of two axes, likewise."""
    found = 0.0
    for i in range(values.shape[0]):
        value = greatest(values[i])
        if value > found or value != value:
            found = value
    return found
