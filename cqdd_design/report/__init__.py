"""The report: one self-contained HTML page that a design review reads, on screen and on paper."""

from cqdd_design.report.build import build_report
from cqdd_design.report.input import ReportInput
from cqdd_design.report.origins import read_comments
from cqdd_design.report.weighing import Bodies, weigh, weigh_if_possible

__all__ = ["Bodies", "ReportInput", "build_report", "read_comments", "weigh", "weigh_if_possible"]
