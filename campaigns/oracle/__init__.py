"""Compare the answers of the working tree with frozen ones: outputs, part volumes, fits, messages and optima."""

import os

for variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"):
    os.environ.setdefault(variable, "1")  # before numpy is loaded: sums of several threads differ from run to run
