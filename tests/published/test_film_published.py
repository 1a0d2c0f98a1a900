"""Films: their formula in its collected form, and published efficiencies with nothing fitted.

Groups of `data/published_examples.csv`: film, efficiency by films.
"""

from __future__ import annotations

from collections.abc import Callable

import pytest
from film_reducer import FilmReducer
from published_rows import inputs, label, published_rows

from cqdd_design.gearbox.film import mixed
from cqdd_design.gearbox.film.thickness import minimum_film
from cqdd_design.gearbox.losses import sliding

EFFICIENCIES = published_rows("efficiency by films")


@pytest.mark.parametrize("row", published_rows("film"), ids=label)
def test_the_formula_in_its_collected_form(
    row: dict[str, str], compared: Callable[..., None]
) -> None:
    g = inputs(row)

    def ours() -> float:
        from cqdd_design.gearbox.film import thickness

        return 1e6 * float(
            thickness.minimum_film(
                1e3 * g["w"],
                g["u"],
                1e-3 * g["R"],
                viscosity=g["eta"],
                pressure_coefficient=1e-9 * g["alpha"],
                modulus=1e9 * g["E"],
            )
        )

    compared(row, ours, minimum_film)


@pytest.mark.parametrize("row", EFFICIENCIES, ids=label)
def test_efficiencies_within_three_points_without_a_fitted_coefficient(
    row: dict[str, str], compared: Callable[..., None]
) -> None:
    reducer = FilmReducer(inputs(row), rollers=True)
    compared(row, reducer.efficiency, sliding.friction_work, mixed.mixed_friction)


def test_fixed_ring_pins_explain_no_published_efficiency() -> None:
    """What the note of the rows says."""
    off = [
        FilmReducer(inputs(row), rollers=False).efficiency() - float(row["value"])
        for row in EFFICIENCIES
    ]
    assert round(100.0 * max(off), 1) == -6.6
    assert round(100.0 * min(off), 1) == -7.9
