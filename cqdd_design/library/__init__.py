"""What ``import cqdd_design`` gives: one function a road, and the results that they return.

A function takes a design or the path of its file, names its other arguments, takes quantities with
their unit, goes one road, and returns a frozen result. What a road needs is imported by the call.
"""
