"""What the kernels of point loads read, by name."""

from __future__ import annotations

from typing import NamedTuple

from cqdd_design.geometry.contours import FloatArray


class Spread(NamedTuple):
    """Places as a kernel reads them, real parts and imaginary ones apart, (N,).

    A place outside has nan as its void.
    """

    point_x: FloatArray
    point_y: FloatArray
    inward_x: FloatArray
    inward_y: FloatArray
    void_x: FloatArray
    void_y: FloatArray
