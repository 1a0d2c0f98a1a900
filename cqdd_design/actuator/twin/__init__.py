"""The compiled kernels in plain numpy: the same equations, written to be read."""
