"""Virtual test bench: every row of an actuator's data sheet, measured on its simulation."""

from cqdd_design.actuator.bench.metric import METRICS, BenchResult, Metric
from cqdd_design.actuator.bench.run import run_bench

__all__ = ["METRICS", "BenchResult", "Metric", "run_bench"]
