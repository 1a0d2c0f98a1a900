"""The report: one self-contained HTML page that a design review reads, on screen and on paper."""

from cqdd_design.machine.weighing import Bodies, weigh, weigh_if_possible
from cqdd_design.report.build import build_report
from cqdd_design.report.input import ReportInput
from cqdd_design.report.judgement.origins import read_comments

__all__ = ["Bodies", "ReportInput", "build_report", "read_comments", "weigh", "weigh_if_possible"]
