"""One judgement of a machine against its requirements, each line by the best model there is."""

from cqdd_design.verdict.judge import Verdict, judge

__all__ = ["Verdict", "judge"]
