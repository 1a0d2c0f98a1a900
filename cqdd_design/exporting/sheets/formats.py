"""Paper that sheets are drawn on (ISO 216, lying) and the border on it (ISO 5457), mm."""

from __future__ import annotations

from dataclasses import dataclass

LEFT, BOTTOM = 20.0, 10.0
"""Of the border: room to file the sheet stays beside it."""
TITLE_WIDTH = 180.0
"""Of the title block, in the lower right corner (ISO 7200)."""

LEAST_SCALE = 0.5
"""Below which a larger sheet is taken: lips and grooves of a millimetre are lost."""


@dataclass(frozen=True)
class Paper:
    """A format, lying.

    Attributes
    ----------
    name : str
        As the title block tells it.
    width, height : float
        Of the trimmed sheet.
    """

    name: str
    width: float
    height: float

    @property
    def right(self) -> float:
        """Right edge of the border."""
        return self.width - 10.0

    @property
    def top(self) -> float:
        """Upper edge of the border."""
        return self.height - 10.0

    @property
    def title(self) -> complex:
        """Lower left corner of the title block."""
        return complex(self.right - TITLE_WIDTH, BOTTOM)


A3 = Paper("A3", 420.0, 297.0)
PAPERS = (
    A3,
    Paper("A2", 594.0, 420.0),
    Paper("A1", 841.0, 594.0),
    Paper("A0", 1189.0, 841.0),
)
"""The smallest first."""


def scale_words(scale: float) -> str:
    """As a title block writes a scale.

    Examples
    --------
    >>> scale_words(2.0), scale_words(0.2)
    ('2 : 1', '1 : 5')
    """
    return f"{scale:g} : 1" if scale >= 1.0 else f"1 : {1.0 / scale:g}"
