"""Candidates as columns: dataclasses whose every field is an array over the same rows."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Self

import numpy as np


@dataclass(frozen=True)
class Columns:
    """Base of a table; every field of it is an array (M, ...)."""

    def rows(self, which: Any) -> Self:
        """Some of the rows, by a mask or by their numbers."""
        return type(self)(*(column[which] for column in vars(self).values()))

    def joined(self, other: Self) -> Self:
        """These rows and others."""
        both = zip(vars(self).values(), vars(other).values(), strict=True)
        return type(self)(*(np.concatenate(columns) for columns in both))
