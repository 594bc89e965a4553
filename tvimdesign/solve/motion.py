"""The tests of the link's motion, by name: `release`, `sine` and `step`, each from a `Rig` to a `Trial`."""

from tvimdesign.solve.release import release
from tvimdesign.solve.sine import sine
from tvimdesign.solve.step import step

__all__ = ["release", "sine", "step"]
