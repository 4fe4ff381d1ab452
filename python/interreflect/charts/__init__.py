"""Charts read records and results only, render nothing, and return matplotlib Figures without global state.

Colours are those of Okabe and Ito, told apart with any colour vision; methods also differ in marker. `dark=True` draws for a
dark page.
"""

from interreflect.charts.curves import curves
from interreflect.charts.records import (
    ERROR_RANGE,
    axis_label,
    images,
    label,
    pictured,
    speed_accuracy,
    stages,
    varied,
    view_title,
)

__all__ = ["ERROR_RANGE", "axis_label", "curves", "images", "label", "pictured", "speed_accuracy", "stages", "varied", "view_title"]
