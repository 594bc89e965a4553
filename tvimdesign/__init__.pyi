# The public names, for type checkers and editors; `__init__.py` loads them when they are asked for.
from pint import Quantity as Quantity

from tvimdesign.api.measured import Fitted as Fitted
from tvimdesign.api.measured import fit as fit
from tvimdesign.api.result import NoDesignError as NoDesignError
from tvimdesign.api.result import Parts as Parts
from tvimdesign.api.result import Reasons as Reasons
from tvimdesign.api.result import Result as Result
from tvimdesign.api.study import Study as Study
from tvimdesign.api.study import example as example
from tvimdesign.api.study import load as load
from tvimdesign.api.study import size as size
from tvimdesign.api.sweep import Cell as Cell
from tvimdesign.api.sweep import Sweep as Sweep
from tvimdesign.base.errors import CatalogError as CatalogError
from tvimdesign.base.errors import GeometryError as GeometryError
from tvimdesign.base.errors import InfeasibleError as InfeasibleError
from tvimdesign.base.errors import InputError as InputError
from tvimdesign.base.errors import SimulationError as SimulationError
from tvimdesign.base.errors import TvimError as TvimError
from tvimdesign.base.errors import UnitError as UnitError
from tvimdesign.study.design import Design as Design
from tvimdesign.study.design import read_design as read_design
from tvimdesign.study.text.mistakes import StudyError as StudyError

__version__: str
