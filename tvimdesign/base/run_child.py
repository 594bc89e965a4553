"""Runs a module of this package as a child: `python -m tvimdesign.base.run_child MODULE [ARGUMENT...]`.

The child asks to end with its parent before the module is imported, which takes seconds where it draws or solves.
"""

import runpy
import sys
import warnings

from tvimdesign.base.child_process import follow_parent
from tvimdesign.base.errors import FolderWarning


def main() -> None:
    """Follow the parent, then be the module."""
    follow_parent()
    warnings.simplefilter("ignore", FolderWarning)  # the parent tells of it
    del sys.argv[0]
    runpy.run_module(sys.argv[0], run_name="__main__", alter_sys=True)


if __name__ == "__main__":
    main()
