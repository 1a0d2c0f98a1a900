"""The machine to look at: assembled, taken apart, cut, and turning in three dimensions."""

from cqdd_design.report.machine_view.model import ViewerData, viewer_data
from cqdd_design.report.machine_view.stills import MachineViews, hidden_line_views

__all__ = ["MachineViews", "ViewerData", "hidden_line_views", "viewer_data"]
