"""The device as compiled functions, and its working cycle simulated with them."""

import os

# Two BLAS threads double the CPU time of systems this small and gain nothing; said before CasADi loads its libraries.
for _name in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"):
    os.environ.setdefault(_name, "1")
