"""CAD: parts, assembly, checks and export. Importing this does not load the CAD kernel; a child process does."""

from tvimdesign.cad.cad_report import CadReport, SolidCheck
from tvimdesign.cad.make import make_cad

__all__ = ["CadReport", "SolidCheck", "make_cad"]
