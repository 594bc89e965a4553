"""CAD: parts, assembly, checks and export. Importing this does not load the CAD kernel; a child process does."""

from tvimdesign.cad.make import make_cad
from tvimdesign.cad.outcome import CadReport, Check

__all__ = ["CadReport", "Check", "make_cad"]
