"""The machine to look at: assembled, taken apart, cut, and turning in three dimensions."""

from cqdd_design.report.machine_view.pictures import MachineViews, hidden_line_views
from cqdd_design.report.machine_view.viewer_data import ViewerData, viewer_data

__all__ = ["MachineViews", "ViewerData", "hidden_line_views", "viewer_data"]
